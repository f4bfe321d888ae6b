#!/usr/bin/env python3
"""White furnaces of imported glTF materials beside Cycles: a page in Markdown, docs/pages/cycles.md.

    python3 -m venv .venv && .venv/bin/pip install bpy==5.0.1      # Blender as a module: 350 MiB, Python 3.11
    .venv/bin/python scripts/furnaces.py LUTHIER docs/pages/cycles.md

Blender reads the same glTF file with its own importer, and Cycles renders squares under light of radiance 1 from everywhere; `luthier import` makes
material files of it, whose stacks `luthier eval --model layered-mc` simulates. Nothing of the two ways is shared. Fails where a material that means the
same thing in both is more than .025 apart up to 60 degrees."""

import base64
import json
import math
import os
import struct
import subprocess
import sys
import tempfile

ANGLES = [0, 30, 60, 75, 85]
# The most that materials of one meaning may be apart up to 60 degrees, and their kinds.
APART = 0.025
SAME = {"metal", "plastic"}
SIDE, SAMPLES = 16, 1024
WHY = """
Metals and plastics mean the same in both, and the other kinds do not:

- **Edges of dielectrics.** glTF has Schlick's formula, and luthier takes it. Cycles takes Fresnel's equations of the index: {0:.3f} less at 85 degrees for an F0 of .04.
- **Mixtures.** Blender mixes a metal and a dielectric under one interface; glTF blends two surfaces, and so does luthier.
- **Coats.** In Cycles a coat dims what lies below and sends nothing back to it. Here light goes to and fro, and a smooth coat keeps slanted light from a metal: gold under lacquer is darker at 75 degrees.

## All materials

Columns of angles have the largest difference of a channel.
"""
PATHS = 200000


def material(name, kind, color, metallic, roughness, **extensions):
    core = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
    found = {"KHR_materials_" + key: value for key, value in extensions.items()}
    return kind, {"name": name, "pbrMetallicRoughness": core, "extensions": found}


def materials():
    """Thirty materials, each with what kind of meaning it has."""
    gold, copper, silver = [1, 0.78, 0.34], [0.95, 0.64, 0.54], [0.96, 0.95, 0.92]
    wood, red, blue, white = [0.4, 0.25, 0.12], [0.6, 0.05, 0.04], [0.1, 0.25, 0.7], [0.9, 0.9, 0.9]
    coat = {"clearcoatFactor": 1}
    out = []
    for color, name in [(gold, "gold"), (copper, "copper"), (silver, "silver")]:
        out += [material(f"{name} {r}", "metal", color, 1, r) for r in (0.1, 0.4, 0.7)]
    for color, name in [(wood, "wood"), (red, "red"), (white, "white")]:
        out += [material(f"{name} plastic {r}", "plastic", color, 0, r) for r in (0.2, 0.5, 0.8)]
    out += [material(f"blue plastic of index {n}", "plastic", blue, 0, 0.3, ior={"ior": n}) for n in (1.3, 1.8)]
    out.append(material("blue plastic, specular 0.5", "plastic", blue, 0, 0.3, specular={"specularFactor": 0.5}))
    out += [material(f"half metal {r}", "mixture", copper, 0.5, r) for r in (0.3, 0.6)]
    out.append(material("steel 0.25", "metal", [0.6, 0.57, 0.54], 1, 0.25))
    out += [material(f"wood under varnish {r}", "coat over plastic", wood, 0, 0.5, clearcoat={**coat, "clearcoatRoughnessFactor": r}) for r in (0, 0.3)]
    out.append(material("white under lacquer", "coat over plastic", white, 0, 0.5, clearcoat=coat))
    out += [material(f"gold under lacquer {r}", "coat over metal", gold, 1, r, clearcoat=coat) for r in (0.2, 0.5)]
    out.append(material("half a coat on red", "coat over plastic", red, 0, 0.4, clearcoat={"clearcoatFactor": 0.5}))
    assert len(out) == 30
    return out


def document(all_of_them):
    """A square for each material, far from the others."""
    square = [(-1, -1, 0), (1, -1, 0), (-1, 1, 0), (1, 1, 0)]
    uv = [(0, 1), (1, 1), (0, 0), (1, 0)]
    data = b"".join(struct.pack("<3f", *corner) for corner in square) + b"".join(struct.pack("<2f", *corner) for corner in uv)
    count = len(all_of_them)
    return {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": list(range(count))}],
        "nodes": [{"mesh": i, "name": f"square {i}"} for i in range(count)],
        "meshes": [{"name": f"square {i}", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "mode": 5, "material": i}]} for i in range(count)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "materials": [given for _, given in all_of_them],
        "extensionsUsed": sorted({name for _, given in all_of_them for name in given["extensions"]}),
    }


def rendered(path, count, folder):
    """Radiance of each square from each angle, by Cycles."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    for addon in ("cycles", "io_scene_gltf2"):
        bpy.ops.preferences.addon_enable(module=addon)
    bpy.ops.import_scene.gltf(filepath=path)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = SAMPLES, False, False
    scene.cycles.max_bounces, scene.cycles.sample_clamp_indirect, scene.cycles.blur_glossy = 32, 0, 0
    for bounces in ("diffuse", "glossy", "transmission"):
        setattr(scene.cycles, bounces + "_bounces", 32)
    scene.render.resolution_x = scene.render.resolution_y = SIDE
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    world = bpy.data.worlds.new("white")
    scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1, 1, 1, 1), 1
    camera = bpy.data.cameras.new("eye")
    camera.type, camera.ortho_scale = "ORTHO", 0.05
    eye = bpy.data.objects.new("eye", camera)
    scene.collection.objects.link(eye)
    scene.camera = eye
    squares = {obj.name: obj for obj in bpy.data.objects if obj.type == "MESH"}
    version, out = bpy.app.version_string, []
    for i in range(count):
        for name, obj in squares.items():
            obj.hide_render = name != f"square {i}"
        rows = []
        for angle in ANGLES:
            # Blender has z upwards: the square of glTF looks towards -y.
            turn = math.radians(angle)
            eye.location = (3 * math.sin(turn), -3 * math.cos(turn), 0)
            eye.rotation_euler = (math.pi / 2, 0, turn)
            scene.render.filepath = os.path.join(folder, "furnace.exr")
            bpy.ops.render.render(write_still=True)
            picture = bpy.data.images.load(scene.render.filepath)
            pixels = list(picture.pixels)
            bpy.data.images.remove(picture)
            rows.append([sum(pixels[c::4]) / (SIDE * SIDE) for c in range(3)])
        out.append(rows)
    return version, out


def simulated(luthier, path):
    """Albedo of a material file at each angle."""
    angles = ",".join(str(angle) for angle in ANGLES)
    command = [luthier, "eval", path, "--model", "layered-mc", "--albedo", "--rgb", "--angles", angles, "--samples", str(PATHS), "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return [row["albedo"] for row in found["albedo"]]


def reflectance(n, angle):
    """Fresnel's equations of a dielectric, for unpolarised light."""
    cos = math.cos(angle)
    inside = math.sqrt(1 - (math.sin(angle) / n) ** 2)
    return 0.5 * (((cos - n * inside) / (cos + n * inside)) ** 2 + ((n * cos - inside) / (n * cos + inside)) ** 2)


def text(rgb):
    return " ".join(f"{c:.3f}" for c in rgb)


def report(version, given, ours, theirs):
    """The page, and materials of one meaning that are apart."""
    # Of an index of 1.5 at 85 degrees.
    schlick, fresnel = 0.04 + 0.96 * (1 - math.cos(math.radians(85))) ** 5, reflectance(1.5, math.radians(85))
    rows = []
    for (kind, material), own, other in zip(given, ours, theirs):
        apart = [max(abs(a - b) for a, b in zip(x, y)) for x, y in zip(own, other)]
        rows.append((kind, material["name"], apart, own, other))
    page = [f"""# Imported materials beside Cycles

`scripts/furnaces.py` makes this page. It writes 30 materials of glTF into one file. Blender {version} reads it with its own importer, and Cycles renders white furnaces: squares under light of radiance 1 from
everywhere, {SIDE * SIDE * SAMPLES:,} paths for each angle. `luthier import` makes material files of it, and `luthier eval --model layered-mc` simulates their stacks with {PATHS:,} paths. The two ways share no code.
Random numbers make differences of up to .003.

## The largest difference of a kind, of any channel

| kind | materials | {" | ".join(f"{angle} degrees" for angle in ANGLES)} |
|---|--:|{"--:|" * len(ANGLES)}"""]
    for kind in dict.fromkeys(row[0] for row in rows):
        of_kind = [row[2] for row in rows if row[0] == kind]
        page.append(f"| {kind} | {len(of_kind)} | {' | '.join(f'{max(column):.3f}' for column in zip(*of_kind))} |")
    page.append(WHY.format(schlick - fresnel))
    page.append(f"| material | kind | {' | '.join(f'{angle}' for angle in ANGLES)} | luthier, 0 degrees | Cycles | luthier, 75 degrees | Cycles |\n|---|---|{'--:|' * len(ANGLES)}---|---|---|---|")
    for kind, name, apart, own, other in rows:
        at = ANGLES.index(75)
        shares = " | ".join(f"{share:.3f}" for share in apart)
        page.append(f"| {name} | {kind} | {shares} | {text(own[0])} | {text(other[0])} | {text(own[at])} | {text(other[at])} |")
    far = [f"{name}: {max(apart[:3]):.3f}" for kind, name, apart, _, _ in rows if kind in SAME and max(apart[:3]) > APART]
    return "\n".join(page) + "\n", far


def main(luthier, output):
    given = materials()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "furnace.gltf")
        with open(path, "w") as file:
            json.dump(document(given), file)
        target = os.path.join(folder, "materials")
        subprocess.run([luthier, "import", path, "-o", target], check=True, capture_output=True)
        with open(os.path.join(target, "import.json")) as file:
            files = [found["file"] for found in json.load(file)["sources"][0]["materials"]]
        ours = [simulated(luthier, os.path.join(target, name)) for name in files]
        version, theirs = rendered(path, len(given), folder)
    # Blender writes its log to standard output.
    page, far = report(version, given, ours, theirs)
    with open(output, "w") as file:
        file.write(page)
    if far:
        sys.exit(f"materials that mean the same are more than {APART} apart up to 60 degrees: " + "; ".join(far))


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]), sys.argv[2])
