"""Claims about the model, each measured against the paper, a formula or another engine.

A claim states a number and its limit. Explanations belong to the pages.

Letters, of one body and one number at a time:

| symbol | unit | meaning |
|---|---|---|
| `R` | - | rotation matrix (3, 3), from a body's frame to the world's |
| `r` | m | arm (3,) from a body's origin to a point; radius |
| `l`, `d`, `depth`, `width`, `offset` | m | lengths |
| `z` | m | height of the centre of mass |
| `phi` | m | gap |
| `chi`, `chi2` | m, m^2 | mu_omega / mu_v; its square |
| `K` | N/m | stiffness of one coordinate |
| `mass`, `inertia` | kg, kg m^2 | of a body |
| `N`, `grip`, `F`, `fx`, `fy` | N | normal force; of a finger; tangential forces |
| `tau`, `limit` | N m | torque about the normal; at which a spin begins |
| `mu` | - or m | the one coefficient of friction in question |
| `v`, `omega` | m/s, rad/s | speed, spin |
| `Pi` | - | quasi-dynamic number v / (mu_v gravity h), which should be far below one |
| `slope`, `angle` | rad | angles |
"""
