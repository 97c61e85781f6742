# SPDX-License-Identifier: MIT
"""Error and propagation time of each basis against path tracing: python3 examples/bases.py"""
import clpv

scene = clpv.Scene("scenes/cornell.json")
eye = clpv.Camera(eye=(0.278, 0.273, -0.18), target=(0.278, 0.273, 0.28), fov=75)
truth = clpv.pathtrace(scene, "indirect", camera=eye, width=240, height=135, noise=0.02)
for basis in clpv.bases():
    r = clpv.Renderer(scene, basis=basis, width=240, height=135)
    print(basis, clpv.compare(r.render("indirect", camera=eye), truth).nrmse,
          clpv.ms_of(r.stats["times"], "propagate"))
