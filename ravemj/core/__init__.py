"""What knows nothing of robots: poses, arrays, files that appear whole."""
