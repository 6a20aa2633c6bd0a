"""Parts of the API of a joint."""
