"""Scenes and motions that browsers draw by themselves, with WebGL.

``surfaces`` makes triangles of a model's geoms, ``packing`` makes bytes of them, ``animation`` adds poses over time and
the page that plays them. ``page/renderer.js`` reads and draws the bytes.
"""
