"""What stands between the shells: absorbers and saturating actuators, solved exactly where they are linear and marched where not."""
