# SPDX-License-Identifier: MIT
"""Writes meshes, nodes, materials and animations as one .glb, or as a .gltf that shares one's
bytes, and PNG textures: bytes that depend on nothing but the input."""
import base64
import json
import struct
import zlib

from clpv import output

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Document:
    """A glTF 2.0 document under construction."""

    def __init__(self, generator):
        self._blob = bytearray()
        self._json = {
            "asset": {"version": "2.0", "generator": generator},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [],
        }
        self._materials = {}
        self._accessors_of = {}

    def texture(self, png):
        """Adds a repeating texture; its index."""
        d = self._json
        d.setdefault("samplers",
                     [{"wrapS": 10497, "wrapT": 10497, "magFilter": 9729, "minFilter": 9987}])
        d.setdefault("images", []).append({"bufferView": self._view(png), "mimeType": "image/png"})
        d.setdefault("textures", []).append({"source": len(d["images"]) - 1, "sampler": 0})
        return len(d["textures"]) - 1

    def material(self, name, colour, texture=None, double_sided=False, radiance=None):
        """`colour`: linear reflectance, which multiplies the texture's. `radiance`: emitted, linear
        RGB."""
        pbr = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        if texture is not None:
            pbr["baseColorTexture"] = {"index": texture}
        entry = {"name": name, "pbrMetallicRoughness": pbr}
        if double_sided:
            entry["doubleSided"] = True
        if radiance is not None:
            strength = max(radiance)
            entry["emissiveFactor"] = [c / strength for c in radiance]
            entry["extensions"] = {
                "KHR_materials_emissive_strength": {"emissiveStrength": strength}
            }
            self._json["extensionsUsed"] = ["KHR_materials_emissive_strength"]
        self._materials[name] = len(self._json["materials"])
        self._json["materials"].append(entry)

    def mesh(self, name, mesh, materials=None):
        """Adds a Mesh; its index, for nodes. `materials` renames some: a mesh may come in several
        colours."""
        primitives = []
        for material, surface in mesh.surfaces.items():
            if surface not in self._accessors_of:
                self._accessors_of[surface] = {
                    "attributes": {
                        "POSITION": self._floats(surface.positions, "VEC3", bounds=True),
                        "NORMAL": self._floats(surface.normals, "VEC3"),
                        "TEXCOORD_0": self._floats(surface.uvs, "VEC2"),
                    },
                    "indices": self._indices(surface.indices),
                }
            index = self._materials[(materials or {}).get(material, material)]
            primitives.append({**self._accessors_of[surface], "material": index})
        self._json["meshes"].append({"name": name, "primitives": primitives})
        return len(self._json["meshes"]) - 1

    def node(self, name, mesh, translation=(0, 0, 0), quarter_turns=0, factor=(1, 1, 1)):
        """Places a mesh; `quarter_turns` round y, counter-clockwise seen from above."""
        half = {0: (0.0, 1.0), 1: (0.5**0.5, 0.5**0.5), 2: (1.0, 0.0), 3: (-(0.5**0.5), 0.5**0.5)}
        sine, cosine = half[quarter_turns % 4]
        entry = {"name": name, "mesh": mesh}
        if tuple(translation) != (0, 0, 0):
            entry["translation"] = list(translation)
        if quarter_turns % 4:
            entry["rotation"] = [0.0, sine, 0.0, cosine]
        if tuple(factor) != (1, 1, 1):
            entry["scale"] = list(factor)
        self._json["scenes"][0]["nodes"].append(len(self._json["nodes"]))
        self._json["nodes"].append(entry)
        return len(self._json["nodes"]) - 1

    def node_named(self, name):
        """Its index and where it stands."""
        index = next(i for i, node in enumerate(self._json["nodes"]) if node["name"] == name)
        return index, self._json["nodes"][index].get("translation", [0, 0, 0])

    def animate(self, node, path, times, values, interpolation="LINEAR"):
        """Moves a node's "translation", "rotation" or "scale" through keys; of a CUBICSPLINE three
        rows of values a key."""
        animations = self._json.setdefault("animations",
                                           [{"name": "life", "samplers": [], "channels": []}])
        samplers, channels = animations[0]["samplers"], animations[0]["channels"]
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
        samplers.append({
            "input": self._floats([(t, ) for t in times], "SCALAR", bounds=True, target=None),
            "output": self._floats(values, f"VEC{len(values[0])}",
                                   target=None), "interpolation": interpolation
        })

    def write(self, path):
        """As a .glb. Returns it, for write_beside."""
        document = {**self._json, "buffers": [{"byteLength": len(self._blob)}]}
        text = json.dumps(document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        blob = bytes(self._blob) + b"\0" * (-len(self._blob) % 4)
        glb = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(blob))
        glb += struct.pack("<I4s", len(text), b"JSON") + text
        glb += struct.pack("<I4s", len(blob), b"BIN\0") + blob
        output.write(path, glb)
        return glb

    def write_beside(self, path, name, glb):
        """As a .gltf that takes what was there when `glb` was written from that file, called
        `name`, and holds the rest."""
        start = 12 + 8 + struct.unpack("<I", glb[12:16])[0] + 8
        shared = len(glb) - start
        views = []
        for view in self._json["bufferViews"]:
            own = view["byteOffset"] >= shared
            views.append({
                **view, "buffer": 1 if own else 0,
                "byteOffset": view["byteOffset"] - shared if own else view["byteOffset"] + start
            })
        rest = bytes(self._blob[shared:])
        data = "data:application/octet-stream;base64," + base64.b64encode(rest).decode()
        document = {
            **self._json, "bufferViews": views, "buffers": [{"uri": name, "byteLength": len(glb)},
                                                            {"uri": data, "byteLength": len(rest)}]
        }
        output.write(path, json.dumps(document, separators=(",", ":")) + "\n")

    def _view(self, data, target=None):
        self._blob += b"\0" * (-len(self._blob) % 4)
        view = {"buffer": 0, "byteOffset": len(self._blob), "byteLength": len(data)}
        if target:
            view["target"] = target
        self._blob += data
        self._json["bufferViews"].append(view)
        return len(self._json["bufferViews"]) - 1

    def _accessor(self, view, component, count, kind, **more):
        self._json["accessors"].append(
            {"bufferView": view, "componentType": component, "count": count, "type": kind, **more})
        return len(self._json["accessors"]) - 1

    def _floats(self, rows, kind, bounds=False, target=ARRAY_BUFFER):
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        more = {}
        if bounds:
            more = {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]}
        return self._accessor(self._view(data, target), FLOAT, len(rows), kind, **more)

    def _indices(self, indices):
        wide = max(indices) > 65534  # 65535 restarts a strip in some interfaces, glTF forbids it
        data = struct.pack(f"<{len(indices)}{'I' if wide else 'H'}", *indices)
        component = UNSIGNED_INT if wide else UNSIGNED_SHORT
        return self._accessor(self._view(data, ELEMENT_ARRAY_BUFFER), component, len(indices),
                              "SCALAR")


def png(width, height, palette, pixels):
    """An 8-bit palette PNG. `palette`: (r, g, b) bytes; `pixels`: one index a pixel, row by row.

    The deflate stream is stored, not compressed: compressors differ from version to version, and
    git compresses anyway.
    """
    rows = b"".join(b"\0" + bytes(pixels[y * width:(y + 1) * width]) for y in range(height))
    stream = bytearray(b"\x78\x01")
    for start in range(0, len(rows), 65535):
        block = rows[start:start + 65535]
        final = start + 65535 >= len(rows)
        stream += struct.pack("<BHH", final, len(block), 0xFFFF - len(block)) + block
    stream += struct.pack(">I", zlib.adler32(rows))

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(
            ">I", zlib.crc32(name + data))

    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
            chunk(b"PLTE", b"".join(bytes(c) for c in palette)) + chunk(b"IDAT", bytes(stream)) +
            chunk(b"IEND", b""))
