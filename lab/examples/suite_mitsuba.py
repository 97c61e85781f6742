#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Renders the still views of the suite (lab/docs/score.md) with the path tracer Mitsuba 3, to score
them.

    pip install mitsuba OpenEXR
    python3 lab/examples/suite_mitsuba.py SUITE OUTPUT [--sponza Sponza.gltf] [--only 'cornell-*']
    python3 -m clpv_lab.score OUTPUT --suite SUITE --only 'cornell-*'

Reads cameras, lights and models of SUITE as any renderer would, and writes OUTPUT/VIEW.NUMBER.exr:
radiance after one bounce. """
import argparse
import fnmatch
import json
import pathlib
import struct
import sys

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
SKIPPED = 8  # back faces and holes in front of a pixel's surface, at most


class Gltf:
    """A static model: meshes in world space, diffuse."""

    def __init__(self, file, scale):
        self.folder, self.scale, data = file.parent, scale, file.read_bytes()
        self.binary = b""
        if data[:4] == b"glTF":
            size = struct.unpack_from("<I", data, 12)[0]
            self.binary, data = data[28 + size:], data[20:20 + size]
        self.document = json.loads(data)
        self.buffers = [
            (self.folder / buffer["uri"]).read_bytes() if "uri" in buffer else self.binary
            for buffer in self.document["buffers"]
        ]

    def bytes_of(self, view):
        view = self.document["bufferViews"][view]
        start = view.get("byteOffset", 0)
        return self.buffers[view["buffer"]][start:start +
                                            view["byteLength"]], view.get("byteStride")

    def values(self, accessor):
        accessor = self.document["accessors"][accessor]
        data, stride = self.bytes_of(accessor["bufferView"])
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        stride = stride or width * kind.itemsize
        return np.ndarray((accessor["count"], width), kind, data, accessor.get("byteOffset", 0),
                          (stride, kind.itemsize)).copy()

    def instances(self):
        """Yields (mesh, matrix) of the default scene."""
        stack = [(node, np.diag([self.scale] * 3 + [1.0]))
                 for node in self.document["scenes"][self.document.get("scene", 0)]["nodes"]]
        while stack:
            index, above = stack.pop()
            node = self.document["nodes"][index]
            if "matrix" in node:
                local = np.reshape(node["matrix"], (4, 4)).T
            else:
                local = np.eye(4)
                local[:3, :3] = rotation(node.get("rotation",
                                                  (0, 0, 0, 1))) * node.get("scale", (1, 1, 1))
                local[:3, 3] = node.get("translation", (0, 0, 0))
            if "mesh" in node:
                yield self.document["meshes"][node["mesh"]], above @ local
            stack += [(child, above @ local) for child in node.get("children", ())]

    def bsdf(self, index):
        material = self.document["materials"][index]
        colour = material.get("pbrMetallicRoughness", {})
        factor = np.array(colour.get("baseColorFactor", (1, 1, 1, 1)))
        if "baseColorTexture" not in colour:
            return {
                "type": "twosided", "bsdf": {
                    "type": "diffuse", "reflectance": {"type": "rgb", "value": list(factor[:3])}
                }
            }
        image = self.document["images"][self.document["textures"][colour["baseColorTexture"]
                                                                  ["index"]]["source"]]
        if "uri" in image:
            bitmap = mi.Bitmap(str(self.folder / image["uri"]))
        else:
            stream = mi.MemoryStream()
            stream.write(self.bytes_of(image["bufferView"])[0])
            stream.seek(0)
            bitmap = mi.Bitmap(stream)
        pixels = np.array(
            bitmap.convert(mi.Bitmap.PixelFormat.RGBA, mi.Struct.Type.Float32,
                           srgb_gamma=False)) * factor

        def texture(channels):
            return {
                "type": "bitmap", "bitmap": mi.Bitmap(np.ascontiguousarray(channels, np.float32)),
                "raw": True
            }

        diffuse = {
            "type": "twosided",
            "bsdf": {"type": "diffuse", "reflectance": texture(pixels[..., :3])}
        }
        if material.get("alphaMode", "OPAQUE") == "OPAQUE":
            return diffuse
        solid = (pixels[..., 3:] >= material.get("alphaCutoff", 0.5)).astype(float)
        return {"type": "mask", "opacity": texture(solid), "bsdf": diffuse}

    def shapes(self):
        bsdfs = {}
        for mesh, matrix in self.instances():
            for part in mesh["primitives"]:
                index, attributes = part["material"], part["attributes"]
                if index not in bsdfs:
                    bsdfs[index] = mi.load_dict(self.bsdf(index))
                properties = mi.Properties()
                properties["bsdf"] = bsdfs[index]
                points = self.values(attributes["POSITION"]) @ matrix[:3, :3].T + matrix[:3, 3]
                triangles = self.values(part["indices"]).reshape(-1, 3)
                if np.linalg.det(matrix[:3, :3]) < 0:
                    triangles = triangles[:, ::-1]
                shape = mi.Mesh("mesh", len(points), len(triangles), properties,
                                "NORMAL" in attributes, "TEXCOORD_0" in attributes)
                values = mi.traverse(shape)
                values["vertex_positions"] = points.ravel().astype(np.float32)
                values["faces"] = triangles.ravel().astype(np.uint32)
                if "NORMAL" in attributes:
                    normals = self.values(attributes["NORMAL"]) @ np.linalg.inv(matrix[:3, :3])
                    values["vertex_normals"] = (
                        normals / np.linalg.norm(normals, axis=1, keepdims=True)).ravel().astype(
                            np.float32)
                if "TEXCOORD_0" in attributes:
                    values["vertex_texcoords"] = self.values(
                        attributes["TEXCOORD_0"]).ravel().astype(np.float32)
                values.update()
                culled = not self.document["materials"][index].get("doubleSided", False)
                shape.add_attribute("face_culled", 1, np.full(len(triangles), culled, np.float32))
                yield shape


def rotation(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def camera_rays(gltf, name, width, height):
    """Rays through the centres of the pixels."""
    node = next(node for node in gltf["nodes"] if node["name"] == name and "camera" in node)
    half = np.tan(gltf["cameras"][node["camera"]]["perspective"]["yfov"] / 2)
    y, x = np.mgrid[:height, :width] + 0.5
    local = np.stack([(2 * x / width - 1) * half * width / height,
                      (1 - 2 * y / height) * half, -np.ones_like(x)], -1).reshape(-1, 3)
    directions = local @ rotation(node["rotation"]).T
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return mi.Ray3f(mi.Point3f(*node["translation"]), mi.Vector3f(*directions.T.astype(np.float32)))


def suns(gltf, names):
    nodes = [node for node in gltf["nodes"] if node["name"] in names and "camera" not in node]
    for node in nodes:
        light = gltf["extensions"]["KHR_lights_punctual"]["lights"][
            node["extensions"]["KHR_lights_punctual"]["light"]]
        colour = [light["intensity"] * channel for channel in light["color"]]
        yield {"type": "directional", "direction": list(rotation(node["rotation"]) @ (0, 0, -1)),
               "irradiance": {"type": "rgb", "value": colour}}


def first_surface(scene, ray):
    """The surface that a camera sees: no hole of a mask, no back face of a single-sided
    material."""
    for _ in range(SKIPPED):
        hit = scene.ray_intersect(ray)
        hole = dr.max(hit.bsdf().eval_null_transmission(hit, hit.is_valid())) > 0.5
        back = (dr.dot(hit.n, ray.d) > 0) & (hit.shape.eval_attribute_1(
            "face_culled", hit, hit.is_valid()) > 0.5)
        ray.o = dr.select(hit.is_valid() & (hole | back), hit.p + 1e-4 * ray.d, ray.o)
    return hit


def render(scene, rays, spp, size, frame, albedo=None):
    """Mean over cosine-distributed directions of the light that surfaces reflect to a pixel's
    surface, times its albedo. `albedo`: in place of Mitsuba's own."""
    # Unlike `path`, `volpath` lets shadow rays through the holes of masks, which do not count as
    # bounces.
    integrator = mi.load_dict({"type": "volpath", "max_depth": 2, "rr_depth": 100})
    hit = first_surface(scene, rays)
    valid = hit.is_valid()
    own = hit.bsdf().eval_diffuse_reflectance(hit)
    smooth = dr.select(dr.isfinite(hit.sh_frame.n.x), hit.sh_frame.n, hit.n)
    normal = mi.Normal3f(dr.select(dr.dot(smooth, rays.d) > 0, -smooth, smooth))
    sampler, total = mi.load_dict({"type": "independent"}), mi.Color3f(0)
    dr.eval(hit, own, normal)
    for i in range(spp):
        sampler.seed(frame * spp + i, dr.width(rays.d))
        wanted = mi.Frame3f(normal).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d()))
        light, _, _ = integrator.sample(scene, sampler, mi.RayDifferential3f(hit.spawn_ray(wanted)),
                                        active=valid)
        total += light
        dr.eval(total)
    light, own, valid = (np.array(values).reshape(-1, values.shape[-1]).T.reshape(*size, -1)
                         for values in (dr.select(valid, total / spp, 0), own, valid))
    return np.concatenate([light * (own if albedo is None else albedo), valid],
                          2).astype(np.float32)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("suite", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--spp", type=int, default=64, help="paths per pixel and frame")
    parser.add_argument("--frames", type=int, default=8,
                        help="of each view; the score tells bias and noise apart")
    parser.add_argument("--sponza", type=pathlib.Path,
                        help="Sponza.gltf; without it, its views are left out")
    parser.add_argument("--only", default="*")
    parser.add_argument(
        "--albedo-of-suite", action="store_true", help=
        "the pixels' albedo is that of the truth, whose textures have mipmaps: scores the light alone"
    )
    given = parser.parse_args()
    suite = json.loads((given.suite / "suite.json").read_text())
    sys.path.insert(0, str(given.suite))  # the scorer, and how clpv writes files
    from clpv import output
    from clpv_lab.score import exr
    folder = output.Folder(given.output, "lab/examples/suite_mitsuba.py")
    for name, entry in suite["scenes"].items():
        views = [
            view for view in suite["views"]
            if view["scene"] == name and fnmatch.fnmatch(view["name"], given.only)
        ]
        if not views or entry["time"] or not (entry["included"] or given.sponza):
            continue
        model = given.suite / entry["model"] if entry["included"] else given.sponza
        shapes = {
            f"shape{i}": shape
            for i, shape in enumerate(Gltf(model, entry["metres_per_unit"]).shapes())
        }
        gltf = json.loads((given.suite / entry["cameras"]).read_text())
        for view in views:
            lights = {f"light{i}": light for i, light in enumerate(suns(gltf, view["lights"]))}
            scene = mi.load_dict({"type": "scene", **shapes, **lights})
            rays = camera_rays(gltf, view["camera"], view["width"], view["height"])
            albedo = None
            if given.albedo_of_suite:
                albedo, _ = exr.colours(exr.read(given.suite / view["truth"]), view["truth"],
                                        "albedo")
            for frame in range(given.frames):
                image = render(scene, mi.Ray3f(rays), given.spp, (view["height"], view["width"]),
                               frame, albedo)
                mi.Bitmap(image).write(str(folder.file(f"{view['name']}.{frame:04}.exr")))
            print(view["name"], flush=True)


if __name__ == "__main__":
    main()
