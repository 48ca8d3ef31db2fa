"""Slice, cylinder or sphere: what two dimensions make of a spherical shock, against the true one in three."""
