"""Scenes and motions that browsers render with WebGL.

``surfaces`` converts a model's geoms to triangles, ``packing`` serializes them, ``animation`` adds poses over time and
the page that plays them. ``page/renderer.js`` reads and draws the result.
"""
