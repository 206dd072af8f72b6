"""Files of clouds and meshes, one format a file."""
