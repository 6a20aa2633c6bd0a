"""Mixins of ``Environment``, one class for each topic."""
