"""The equations of motion as arrays, and what drives them."""
