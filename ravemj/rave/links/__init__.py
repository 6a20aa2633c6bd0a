"""Parts of the API of a link."""
