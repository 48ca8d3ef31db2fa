"""The paper's scheme: time marching with history sums of the response functions and finite differences."""
