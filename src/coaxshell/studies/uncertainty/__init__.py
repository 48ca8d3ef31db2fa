"""Uncertain properties: how far an answer depends on them, and what they make of a design."""
