# SPDX-License-Identifier: MIT
"""Writes the suite of views that python3 -m clpv_lab.score scores: truths, cameras and lights for
any renderer (lab/docs/score.md).

    lab/scripts/suite --output DIR --model PATH/Sponza.gltf    DIR/suite.json and the files that it
                                                           names, and DIR.tar with them alone

DIR: a new or empty folder, or one that lab/scripts/suite wrote.

The views are those of the standing benchmark and Sponza under three other suns. Needs a built clpv
and oiiotool; traces the ground truths that `clpv quality` has not cached, a minute of processor
time each. Sponza's model is not included. """
import hashlib
import io
import json
import pathlib
import subprocess
import tarfile
import tempfile

from . import ROOT, model_files, native, output, parser_of
from .measure import run

clpv = native()

SCHEMA, SIZE, NOISE = 1, (240, 135), 0.03
# Scenes and their cameras (none: all), files of other names, instants [s], cameras and lights then,
# layers of truths, and what suite.json says of units and conventions.
DATA = json.loads(pathlib.Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
SCENES, FILES, TIMES, LAYERS = (DATA[name] for name in ("scenes", "files", "times", "layers"))
LARGEST = 64 * 2**20  # bytes of the tar
SCORER = (("python", "clpv/output.py", "clpv/draw/viewer.*"),
          ("lab/python", "clpv_lab/score/*.py", "clpv_lab/score/*.html"))  # files by their root


def views_gltf(scene, model):
    """glTF of a scene file's cameras and lights, in metres: the JSON that the library writes for
    them without the model. Nodes have the lights' names."""
    with tempfile.TemporaryDirectory() as folder:
        file, views = pathlib.Path(folder) / "views.json", clpv.Scene()
        file.write_text(json.dumps({**scene, "model": str(model)}), encoding="utf-8")
        given = clpv.Scene(file)
        views.cameras = [camera.replace(light="") for camera in given.cameras]
        views.lights = given.lights
        views.save(file.with_suffix(".glb"))
        data = file.with_suffix(".glb").read_bytes()
    size = int.from_bytes(data[12:16], "little")  # of the first chunk, which begins at 20
    gltf = json.loads(data[20:20 + size])
    lights = gltf["extensions"]["KHR_lights_punctual"]["lights"]
    for node in gltf["nodes"]:
        if "extensions" in node:
            node["name"] = lights[node["extensions"]["KHR_lights_punctual"]["light"]]["name"]
    for camera in gltf["cameras"]:
        camera["perspective"]["aspectRatio"] = SIZE[0] / SIZE[1]
    return gltf


def ground_truths(name, cameras, model):
    """Traces what is not cached. Returns rows of `clpv quality`: file, camera, noise, spp."""
    return run("quality", f"scenes/{FILES.get(name, name)}.json",
               *(f"--camera={camera}" for camera in cameras),
               *([f"--model={model}"] if model else []),
               f"--time={TIMES.get(name, 0)}", f"--width={SIZE[0]}", f"--height={SIZE[1]}",
               f"--noise={NOISE}", "--preset=fast", "--frames=1", "--output")["ground_truths"]


def in_halves(source):
    """Bytes of a truth with the suite's layers as halves."""
    channels = ",".join(f"{layer}.{channel}" for layer in LAYERS for channel in "RGBA")
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / source.name
        subprocess.run(["oiiotool", source, "--ch", channels, "-d", "half", "--compression", "zip",
                        "-o", target], check=True)
        return target.read_bytes()


def add_scene(folder, name, sponza):
    """Writes a scene's files into an output.Folder. Returns its entry and those of its views."""
    scene = json.loads((ROOT / f"scenes/{FILES.get(name, name)}.json").read_text())
    scene.update(DATA["at_their_time"].get(name, {}))
    ours = scene["model"] != "Sponza.gltf"
    model = ROOT / "scenes" / scene["model"] if ours else sponza
    if ours:
        for file in model_files(model):
            folder.write(f"models/{file.name}", file.read_bytes())
    cameras = {camera["name"]: camera for camera in scene["cameras"]
               if not SCENES[name] or camera["name"] in SCENES[name]}
    gltf = views_gltf({**scene, "cameras": list(cameras.values())}, model)
    folder.write(f"cameras/{name}.gltf", json.dumps(gltf, indent=1) + "\n")
    views, lights = [], [light["name"] for light in scene["lights"]]
    for traced in ground_truths(name, cameras, None if ours else sponza):
        source, camera = pathlib.Path(traced["file"]), cameras[traced["camera"]]
        truth = in_halves(source)
        folder.write(f"truths/{source.name}", truth)
        views.append({
            "name": f"{name}-{traced['camera']}", "scene": name, "camera": traced["camera"],
            "lights": [camera["light"]] if "light" in camera else lights,
            "truth": f"truths/{source.name}",
            "sha256": hashlib.sha256(truth).hexdigest(), "noise": traced["noise"],
            "paths": traced["spp"], "exposure": scene.get("exposure", 0),
            "width": SIZE[0], "height": SIZE[1]})
    hashes = {file.name: hashlib.sha256(file.read_bytes()).hexdigest()
              for file in model_files(model)}
    return {"model": f"models/{model.name}" if ours else model.name, "included": ours,
            "sha256": hashes, "metres_per_unit": scene.get("metres_per_unit", 1),
            "time": TIMES.get(name, 0), "cameras": f"cameras/{name}.gltf"}, views


def packed_files(folder):
    """Bytes of a tar of the files written into an output.Folder, without owners and times."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name in sorted(set(folder.written)):
            entry = tarfile.TarInfo(f"{folder.path.name}/{name}")
            entry.size, entry.mode = (folder.path / name).stat().st_size, 0o644
            with open(folder.path / name, "rb") as file:
                archive.addfile(entry, file)
    return packed.getvalue()


def write_suite(folder, tar, sponza, names):
    """`folder`: output.Folder; `tar`: a file."""
    scenes, views = {}, []
    for name in names:
        scenes[name], found = add_scene(folder, name, sponza)
        views += found
    whole = hashlib.sha256("".join(view["name"] + view["sha256"]
                                   for view in views).encode()).hexdigest()[:16]
    document = {"schema": SCHEMA, "hash": whole, "units": DATA["units"],
                "conventions": DATA["conventions"], "scenes": scenes, "views": views}
    folder.write("suite.json", json.dumps(document, indent=1) + "\n")
    for root, *patterns in SCORER:
        for file in (file for pattern in patterns for file in sorted((ROOT / root).glob(pattern))):
            folder.write(str(file.relative_to(ROOT / root)), file.read_bytes())
    for file in ROOT / "lab/docs/score.md", ROOT / "LICENSE":
        folder.write(file.name, file.read_bytes())
    packed = packed_files(folder)
    if len(packed) > LARGEST:
        raise output.Failure(f"{tar}: found {len(packed)} bytes; allowed: {LARGEST}")
    output.write(tar, packed)
    print(f"{tar}: {len(views)} views, {len(packed) / 2**20:.1f} MiB")


def main():
    parser = parser_of(__doc__)
    parser.add_argument("--output", metavar="DIR", type=pathlib.Path, required=True,
                        help="folder of the suite; DIR.tar beside it")
    parser.add_argument("--scene", metavar="NAME", action="append", choices=SCENES,
                        help="some scenes, repeatable (default: all)")
    arguments = parser.parse_args()
    names = arguments.scene or list(SCENES)
    if any(name.startswith("sponza") for name in names) and not arguments.model:
        parser.error("--model: needed for Sponza")
    place = arguments.output.resolve()
    packed = place.with_name(place.name + ".tar")
    if packed.exists() and not (place / output.MARKER).exists():
        parser.error(f"--output {place}: found a file {packed}; allowed: none where DIR is new")
    output.target_of(packed)
    write_suite(output.Folder(place, "lab/scripts/suite"), packed, arguments.model, names)
    return 0
