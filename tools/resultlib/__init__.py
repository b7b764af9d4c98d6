"""What tools/results is made of."""
