"""The API of an environment, in parts by topic; ``Environment`` joins them."""
