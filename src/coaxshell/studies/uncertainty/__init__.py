"""Uncertain properties: how far an answer depends on each of them, and what they make of a design."""
