"""Foundations without robots: poses, arrays, graphs, handles, output files."""
