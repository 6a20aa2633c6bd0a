"""The methods of environments, one class for each topic. ``Environment`` inherits them."""
