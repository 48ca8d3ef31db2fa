"""Thin or exact walls: how far thin-wall theory is from layers as elastic solids, by thickness, pulse and duration; a report."""
