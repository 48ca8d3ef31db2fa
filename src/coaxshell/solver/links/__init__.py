"""Links of any force law: what a law tells the march, the laws, and the implicit step that keeps their energy."""
