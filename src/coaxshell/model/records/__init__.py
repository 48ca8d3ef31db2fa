"""Measured pressure records: read from files as people have them, conditioned, measured, remarked upon and written without loss."""
