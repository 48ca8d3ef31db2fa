"""Three dimensions: the answer along the axis as a sum over axial wavenumbers."""
