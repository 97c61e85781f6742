# SPDX-License-Identifier: MIT
"""Scenes of trimesh's meshes (Scene.from_trimesh). Imports trimesh only where its objects are
given."""
import numpy

import clpv


def _linear(encoded):
    """Decodes sRGB (IEC 61966-2-1)."""
    return numpy.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _colours(values):
    """Linear RGBA of trimesh's colours, which are uint8 and sRGB-encoded."""
    made = numpy.asarray(values, dtype=numpy.float64) / 255
    made[..., :3] = _linear(made[..., :3])
    return made


def _look(mesh):
    """Arguments of add_mesh() for a mesh's colours or texture."""
    visual = mesh.visual
    if visual.kind == "texture" and visual.uv is not None:
        material = visual.material.to_simple() if hasattr(visual.material,
                                                          "to_simple") else visual.material
        if material.image is not None:
            texture = numpy.asarray(material.image.convert("RGBA"))
            return {"uvs": visual.uv * (1, -1) + (0, 1), "material": clpv.Material(texture=texture)}
        return {"material": clpv.Material(base_colour=_colours(material.main_color))}
    if visual.kind == "vertex":
        return {"colours": _colours(visual.vertex_colors)}
    return {"material": clpv.Material(base_colour=_colours(visual.main_color))}


def scene_of_trimesh(given):
    """A clpv.Scene of a trimesh.Trimesh or a trimesh.Scene."""
    import trimesh
    if isinstance(given, trimesh.Trimesh):
        given = trimesh.Scene(given)
    if not isinstance(given, trimesh.Scene):
        raise TypeError(
            f"from_trimesh: found {type(given).__name__}, allowed: trimesh.Trimesh or trimesh.Scene"
        )
    scene, numbers = clpv.Scene(), {}
    for node in given.graph.nodes_geometry:
        transform, name = given.graph[node]
        mesh = given.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh):
            continue
        if name in numbers:
            scene.add_instance(numbers[name], transform)
        else:
            numbers[name] = scene.add_mesh(mesh.vertices, mesh.faces, transform=transform,
                                           **_look(mesh))
    return scene
