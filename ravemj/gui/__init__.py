"""Viewers: mouse and keys, windows, pages in a browser."""
