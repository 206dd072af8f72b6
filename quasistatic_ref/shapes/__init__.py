"""Shapes, one a file: distance, support, corners, normals, surface and words of each.

| symbol | shape | unit | meaning |
|---|---|---|---|
| `points`, `vertices` | (N, 3), (V, 3) | m | of a cloud, in the shape's frame; of a solid |
| `radius`, `half_length`, `half_width` | scalar | m | of what is round; of a floor that is drawn |
| `length` | scalar | m | of a capsule its straight part |
| `half_extents`, `half_axes` | (3,) | m | of a box, of an ellipsoid |
| `quaternion` | (4,) | - | [x y z w], or as its place says |
| `normal`, `axis`, `direction`, `normals`, `directions` | (3,), (F, 3) | - | unit vectors |
"""
