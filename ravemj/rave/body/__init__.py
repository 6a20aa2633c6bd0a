"""The API of a body, in parts by topic; ``KinBody`` joins them."""
