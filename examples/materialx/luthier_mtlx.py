#!/usr/bin/env python3
"""A bake as a library of MaterialX 1.39: luthier_mtlx.py BAKE -o OUT

BAKE is the folder of `luthier bake --target glsl-es300 --form baked --functions surface --no-zstd`; with `--functions surface,sample` the materials show
environments, too. OUT gets a node of type BSDF for each material, their one implementation for GLSL, ESSL, Vulkan, WGSL, Metal and Slang, the tables as an image,
the maps, and a document with a surfacematerial for each. It needs `pip install materialx`.
"""

import argparse
import hashlib
import json
import pathlib
import re
import sys

import MaterialX as mx

import tables
from place import TYPES, Place
from shader import ARGUMENT, SIGNATURE, TRANSFORMS, Text

ANEW = "bake anew with --target glsl-es300 --form baked --functions surface --no-zstd"


class Bake:
    """The folder of a bake, as far as a library needs it."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        path = self.folder / "manifest.json"
        try:
            self.manifest = json.loads(path.read_text())
            schema = self.manifest["schema"]
        except (OSError, ValueError, KeyError, TypeError) as reason:
            raise tables.Unreadable(f"{path}: is no manifest of a bake ({reason}): {ANEW}")
        if schema != 4:
            raise tables.Unreadable(f"{path}: has schema {schema}, and this program reads schema 4: use luthier of the version of this program, and {ANEW}")
        if "surface" not in self.manifest.get("functions", []):
            raise tables.Unreadable(f"{path}: the bake lacks the functions of surfaces: {ANEW}")
        shader = next((entry for entry in self.manifest["shaders"] if (entry["target"], entry["form"]) == ("glsl-es300", "baked")), None)
        if not shader:
            raise tables.Unreadable(f"{path}: the bake lacks the form baked of the shader for glsl-es300: {ANEW}")
        self.prefix = self.manifest.get("names", {}).get("prefix", "luthier")
        self.text = Text(self.read(shader["file"]).decode(), self.prefix)

    def read(self, file):
        """Bytes of a file that the manifest names."""
        path = self.path(file)
        try:
            data = path.read_bytes()
        except OSError as reason:
            raise tables.Unreadable(f"{path}: {reason.strerror}: {ANEW}")
        if hashlib.sha256(data).hexdigest() != file["sha256"]:
            raise tables.Unreadable(f"{path}: is not the file of this bake: {ANEW}")
        return data

    def path(self, file):
        """The place of a file, within the folder; that of a bake that is being published comes first."""
        for folder in (self.folder / ".luthier-ready", self.folder):
            path = folder / file["path"]
            if not path.resolve().is_relative_to(self.folder.resolve()):
                raise tables.Unreadable(f"{path}: is outside of the folder of the bake: {ANEW}")
            if path.exists():
                break
        return path


class Library:
    """The files of a bake for MaterialX, by name, and its documents."""

    def __init__(self, bake):
        self.bake, self.prefix = bake, bake.prefix
        self.files = {f"{self.prefix}/{name}": text.replace("LUTHIER", self.prefix.upper()).encode() for name, text in TRANSFORMS.items()}
        manifest = bake.manifest
        images = {}
        for table in manifest["tables"]:
            if f"{self.prefix}_{table['kind']}" in {binding["name"] for binding in manifest["bindings"]}:
                bake.read(table["texture"])
                images[table["kind"]] = tables.read(bake.path(table["texture"]), table["format"])
        image = tables.pack(images, bake.read(manifest["material_buffer"]))
        self.files[f"{self.prefix}_tables.png"] = image.data
        layout = {name: (wide, high, image.first[name]) for name, (wide, high, _) in images.items()}
        self.places = [Place(entry, bake.text) for entry in manifest["materials"]]
        roots = {f"{self.prefix}_{name}" for name in ("place", "prepare_at", "light")}
        roots |= {f"{self.prefix}_sample"} & set(bake.text.functions)
        roots = roots.union(*(place.functions for place in self.places))
        common, self.reading = bake.text.common(roots, layout, image)
        self.files[f"{self.prefix}/{self.prefix}.glsl"] = common.encode()
        self.definitions, self.document = mx.createDocument(), mx.createDocument()
        self.document.setColorSpace("lin_rec709")
        for number, place in enumerate(self.places):
            self.define(number, place)
            self.show(place)

    def name(self, place):
        """Name of a material's node."""
        return f"{self.prefix}_{identifier(place.entry['name'])}"

    def define(self, number, place):
        """The node of a material, and its implementation."""
        name = self.name(place)
        definition = self.definitions.addNodeDef(f"ND_{name}", "BSDF", name)
        definition.setNodeGroup("pbr")
        definition.setAttribute("bsdf", "R")
        definition.setDocString(f"{place.entry['name']}, a material that luthier baked: {place.entry['model']}")
        add = lambda name, kind, **attributes: [definition.addInput(name, kind)] + [definition.getInput(name).setAttribute(*item) for item in attributes.items()]
        add("tables", "filename", uniform="true", doc="The tables of the bake.")
        add("slope_variance", "float", value="0", uimin="0", doc="Variance of the slopes of the normals in a pixel; it widens highlights as the size of a lamp does.")
        add("normal", "vector3", defaultgeomprop="Nworld", doc="Normal of the surface.")
        add("tangent", "vector3", defaultgeomprop="Tworld", doc="Tangent of the surface.")
        parameters = ["ClosureData closureData", SIGNATURE, "float slope_variance", "vec3 normal", "vec3 tangent"]
        if place.takes_uv:
            add("texcoord", "vector2", defaultgeomprop="UV0", doc="Texture coordinate; v counts from the bottom.")
            parameters.append("vec2 texcoord")
        for given in place.inputs:
            if given.name != "normal":
                add(given.name, given.type, value=given.default, doc=f"{given.doc[0].upper()}{given.doc[1:]}.")
                parameters.append(f"{TYPES[given.type]} {given.name}")
        implementation = self.definitions.addImplementation(f"IM_{name}_genglsl")
        implementation.setNodeDef(definition)
        implementation.setTarget("genglsl")
        implementation.setFile(f"{name}.glsl")
        implementation.setFunction(f"{name}_bsdf")
        lines = [
            f"const uint material = {self.bake.text.material(number)};",
            f"{self.bake.text.type}MxFrame frame = {self.prefix}_mx_frame(closureData, tangent);",
            f"{self.bake.text.type}Place place = {self.prefix}_place();",
            "place.slope_variance = slope_variance;",
            f"place.normal = {self.prefix}_mx_normal(frame, normal);",
            *(self.called(line) for line in place.lines),
            f"{self.prefix}_mx_shade(closureData, {ARGUMENT}, frame, place, material, bsdf);",
        ]
        text = [
            f'#include "{self.prefix}.glsl"', "", "#define sampler2D(image, sampling) image, sampling", "",
            f"void {name}_bsdf({', '.join([*parameters, 'inout BSDF bsdf'])})", "{", *(f"    {line}" for line in lines), "}", "", "#undef sampler2D", "",
        ]
        self.files[f"{self.prefix}/{name}.glsl"] = "\n".join(text).encode()

    def called(self, line):
        """A line with the image as the first argument of functions that read it."""
        for name in self.reading:
            line = re.sub(rf"\b{name}\(", f"{name}({ARGUMENT}, ", line)
        return line

    def show(self, place):
        """The material in the document: images, node, surface and surfacematerial."""
        name, document = identifier(place.entry["name"]), self.document
        shown = document.addNode(self.name(place), f"{name}_bsdf", "BSDF")
        shown.addInput("tables", "filename").setValueString(f"{self.prefix}_tables.png")
        for given in place.inputs:
            shown.addInput(given.name, given.type).setNodeName(self.image(place, given))
        surface = document.addNode("surface", f"{name}_surface", "surfaceshader")
        surface.addInput("bsdf", "BSDF").setNodeName(shown.getName())
        document.addMaterialNode(name, surface)

    def image(self, place, given):
        """Name of the node that has the value of a map."""
        record, name = given.map, f"{identifier(place.entry['name'])}_{given.name}"
        self.files[record["file"]["path"]] = self.bake.read(record["file"])
        image = self.document.addNode("image", f"{name}_image", given.type)
        file = image.addInput("file", "filename")
        file.setValueString(record["file"]["path"])
        if record.get("srgb"):
            file.setColorSpace("srgb_texture")
        if record["slot"] == "flake-normal":
            image.addInput("filtertype", "string").setValueString("closest")
        rows = record.get("transform", [[1, 0, 0], [0, 1, 0]])
        tiling = place.entry["constants"]["flakes"]["tiling"] if record["slot"] == "flake-normal" else 1
        if rows != [[1, 0, 0], [0, 1, 0]] or tiling != 1:
            (a, b, c), (d, e, f) = rows
            # Rows of the manifest count v from the top, and matrices of MaterialX have vectors on their left.
            matrix = [tiling * a, -tiling * d, 0, -tiling * b, tiling * e, 0, tiling * b + c, 1 - tiling * e - f, 1]
            turned = self.document.addNode("transformmatrix", f"{name}_uv", "vector2")
            texcoord = self.document.addNode("texcoord", f"{name}_texcoord", "vector2")
            turned.addInput("in", "vector2").setNodeName(texcoord.getName())
            turned.addInput("mat", "matrix33").setValueString(", ".join(map(str, matrix)))
            image.addInput("texcoord", "vector2").setNodeName(turned.getName())
        if record["slot"] == "normal":
            return self.after(image, "normalmap", f"{name}_map", "vector3", "in", {})
        factor = record.get("factor", [1, 1, 1])
        if factor != [1, 1, 1]:
            value = str(factor[0]) if given.type == "float" else ", ".join(map(str, factor))
            return self.after(image, "multiply", f"{name}_scaled", given.type, "in1", {"in2": value})
        return image.getName()

    def after(self, node, category, name, kind, taken, values):
        """Name of a node behind another one."""
        next_node = self.document.addNode(category, name, kind)
        next_node.addInput(taken, node.getType()).setNodeName(node.getName())
        for given, value in values.items():
            next_node.addInput(given, kind).setValueString(value)
        return next_node.getName()

    def write(self, out):
        """Writes all files into a folder."""
        for name, data in self.files.items():
            (out / name).parent.mkdir(parents=True, exist_ok=True)
            (out / name).write_bytes(data)
        mx.writeToXmlFile(self.definitions, str(out / self.prefix / f"{self.prefix}_defs.mtlx"))
        mx.writeToXmlFile(self.document, str(out / "materials.mtlx"))


def identifier(name):
    """A name as MaterialX and GLSL have them."""
    return re.sub(r"_+", "_", re.sub(r"\W", "_", name))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("bake", help="the folder of a bake")
    parser.add_argument("-o", "--out", required=True, type=pathlib.Path, help="the folder of the library")
    given = parser.parse_args()
    try:
        library = Library(Bake(given.bake))
    except tables.Unreadable as reason:
        sys.exit(f"error: {reason}" if given.bake in str(reason) else f"error: {given.bake}: {reason}")
    library.write(given.out)
    print(f"{given.out / 'materials.mtlx'}: {len(library.places)} materials")


if __name__ == "__main__":
    main()
