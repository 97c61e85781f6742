# SPDX-License-Identifier: MIT
"""Scenes of trimesh's meshes (Scene.from_trimesh). Does not import trimesh."""
import sys

import numpy

import clpv


def _colours(values):
    """Colours of trimesh as fractions. They are linear, as in the glTF that it reads and writes."""
    given = numpy.asarray(values)
    largest = numpy.iinfo(given.dtype).max if given.dtype.kind in "iu" else 1
    return numpy.clip(given / largest, 0, 1)


def _material(given):
    """Arguments of clpv.Material of a PBRMaterial or another material of trimesh."""
    if not hasattr(given, "baseColorFactor"):
        if given.image is None:
            return {"base_colour": _colours(given.main_color)}
        return {"texture": numpy.asarray(given.image.convert("RGBA"))}
    look = {"double_sided": bool(given.doubleSided)}
    if given.baseColorFactor is not None:
        look["base_colour"] = _colours(given.baseColorFactor)
    if given.baseColorTexture is not None:
        look["texture"] = numpy.asarray(given.baseColorTexture.convert("RGBA"))
    if given.emissiveFactor is not None and given.emissiveTexture is None:
        look["emission"] = given.emissiveFactor
    if given.alphaMode in ("MASK", "BLEND"):  # BLEND is MASK at 0.5, as in a file
        blends = given.alphaMode == "BLEND" or given.alphaCutoff is None
        look["alpha_cutoff"] = 0.5 if blends else given.alphaCutoff
    return look


def _arguments(mesh):
    """Arguments of add_mesh() for a mesh with its colours or texture."""
    visual = mesh.visual
    if visual.kind == "face":  # a vertex for each corner
        return {"positions": mesh.triangles.reshape(-1, 3),
                "triangles": numpy.arange(3 * len(mesh.faces)).reshape(-1, 3),
                "colours": numpy.repeat(_colours(visual.face_colors), 3, axis=0)}  # yapf: disable
    made = {"positions": mesh.vertices, "triangles": mesh.faces}
    if "vertex_normals" in mesh._cache:  # the file's: computed ones would be smooth everywhere
        made["normals"] = mesh.vertex_normals
    if visual.kind == "vertex":
        return made | {"colours": _colours(visual.vertex_colors)}
    if visual.kind != "texture":  # without colours: white, as in a file without a material
        return made
    if "color" in visual.vertex_attributes:
        made["colours"] = _colours(visual.vertex_attributes["color"])
    look = _material(visual.material)
    if visual.uv is None:
        look.pop("texture", None)
    else:
        made["uvs"] = visual.uv * (1, -1) + (0, 1)
    return made | {"material": clpv.Material(**look)}


def scene_of_trimesh(given):
    """A clpv.Scene of a trimesh.Trimesh or a trimesh.Scene."""
    trimesh = sys.modules.get("trimesh")  # whoever has an object of it has imported it
    if trimesh is not None and isinstance(given, trimesh.Trimesh):
        given = trimesh.Scene(given)
    if trimesh is None or not isinstance(given, trimesh.Scene):
        raise clpv.UsageError(f"from_trimesh: given: found {type(given).__name__}, allowed: "
                              "trimesh.Trimesh or trimesh.Scene")
    scene, numbers = clpv.Scene(), {}
    for node in given.graph.nodes_geometry:
        transform, name = given.graph[node]
        mesh = given.geometry[name]
        if not isinstance(mesh, trimesh.Trimesh):
            continue
        if name in numbers:
            scene.add_instance(numbers[name], transform)
        else:
            numbers[name] = scene.add_mesh(transform=transform, **_arguments(mesh))
    return scene
