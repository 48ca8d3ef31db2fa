"""What is built on the core and that the core does not know: command line, studio, the paper reproduced, verification."""
