"""What knows nothing of shells or fluids: files and arrays."""
