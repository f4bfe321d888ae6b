"""What varies over a surface: inputs of a material's node, and the lines of shader that write them into a `LuthierPlace` (docs/manifest.md, Maps)."""

from dataclasses import dataclass

from tables import Unreadable


@dataclass
class Input:
    """An input of a node. Where a map of the bake fills it, `map` is its record in the manifest."""

    name: str
    type: str
    default: str
    line: str
    map: dict = None
    doc: str = ""


TYPES = {"float": "float", "color3": "vec3", "vector3": "vec3", "vector2": "vec2"}
FLAT = "0.5, 0.5, 1"
# By slot: type, value without a map, the line for the whole surface or None, the line for a layer or None, and what the input is.
SLOTS = {
    "roughness": ("float", "1", "place.alpha_factor = {v} * {v};", None, "roughness over that of the material"),
    "thickness": ("float", "1", "place.slab_factor = {v};", "{own}.slab_factor = {v};", "thickness of the slab over that of the material"),
    "absorption": ("color3", "1, 1, 1", None, "{own}.absorption_factors = {v};", "absorption of the slab over that of the material"),
    "weight": ("float", "1", "place.weight_factor = {v};", None, "weight of the coat over that of the material"),
    "patina": ("float", "1", "place.patina = {p}_patina_amount(material, {v});", None, "value of the patina's map"),
    "flake-normal": ("vector3", FLAT, "place.flake_normal = {p}_flake_tilt(material, 2.0 * {v} - 1.0, distance);", None, "texel of the flakes' normal map"),
    "bumps": ("vector3", FLAT, None, "{own}.normal = {p}_mx_unit({v});", "texel of a normal map of the layer"),
    "alpha": ("float", "1", None, "{own}.alpha_factors *= {v};", "slope parameter over that of the material"),
    "alpha-x": ("float", "1", None, "{own}.alpha_factors.x *= {v};", "slope parameter along the tangent over that of the material"),
    "alpha-y": ("float", "1", None, "{own}.alpha_factors.y *= {v};", "slope parameter across the tangent over that of the material"),
    "tangent": ("vector2", "1, 0.5", None, "{own}.tangent = {p}_tangent({v});", "texel of a tangent map of the layer"),
    "albedo": ("color3", "-1, -1, -1", "place.base_color = {v};", None, "albedo of the diffuse base; below 0 that of the material"),
    "lean": ("vector3", FLAT, "place.inner_normal = {p}_lean({p}_mx_unit({v}), place.inner_normal);", None, "texel of the normal map of the film's lower boundary"),
    "f0": ("color3", None, "place = {p}_f0_place(place, material, {v});", None, "reflectance at normal incidence"),
    # They take effect together, in the end.
    "base-color": ("color3", None, "", None, "colour of the base, linear"),
    "metallic": ("float", None, "", None, "share of metal"),
}
# What the line of a slot needs of the bake: a function, or a member of the place or of its layers.
NEEDS = {
    "weight": "weight_factor", "patina": "patina", "flake-normal": "flake_normal", "albedo": "base_color", "lean": "inner_normal",
    "f0": "f0_place", "base-color": "metallic_place", "metallic": "metallic_place", "absorption": "absorption_factors", "bumps": "normal",
    "alpha": "alpha_factors", "alpha-x": "alpha_factors", "alpha-y": "alpha_factors", "tangent": "tangent",
}


class Place:
    """Inputs and lines of the material `entry` of a bake whose shader is `text`."""

    def __init__(self, entry, text):
        self.entry, self.text, self.prefix = entry, text, text.prefix
        self.inputs, self.functions, lines = [], set(), []
        constants = entry["constants"]
        if any(layer["thickness_tile"] is not None for layer in entry["layers"]):
            lines += self.call("film_place", "place = {p}_film_place(place, material, uv);")
        if constants["flakes"]:
            lines += self.call("flake_normal", "place.flake_normal = {p}_flake_normal(material, uv, distance);")
        # An F0 may depend on the weight of the coat above.
        maps = sorted(entry["maps"], key=lambda record: record["slot"] == "f0")
        for record in maps:
            lines += self.filled(record["slot"], record["layer"], record)
        if any(given.name in ("base_color", "metallic") for given in self.inputs):
            names, (color, metal) = [given.name for given in self.inputs], uncoloured(entry)
            color = "base_color" if "base_color" in names else f"vec3({', '.join(map(str, map(float, color)))})"
            metal = "metallic" if "metallic" in names else str(metal)
            lines += self.call("metallic_place", f"place = {{p}}_metallic_place(place, material, {color}, {metal});")
        if constants["glitter"]:
            lines += self.call("glitter_normal", "if ({p}_glitter_normal(material, uv).z < 1.0) { place.normal = {p}_glitter_normal(material, uv); }")
        if any("distance" in line for line in lines):
            lines.insert(0, "float distance = length($viewPosition - closureData.P);")
        if any("uv" in line for line in lines):
            lines.insert(0, "vec2 uv = vec2(texcoord.x, 1.0 - texcoord.y);")
        self.lines = lines
        self.takes_uv = bool(lines) and lines[0].startswith("vec2 uv")

    def call(self, function, line):
        """A line that calls a function, where the bake has it."""
        name = f"{self.prefix}_{function}"
        if name not in self.text.functions:
            return []
        self.functions.add(name)
        return [line.replace("{p}", self.prefix)]

    def filled(self, slot, layer, record):
        """The line of a map, where the model shows it; and its input."""
        if slot == "normal":
            self.inputs.append(Input("normal", "vector3", None, "", record))
            return []
        if slot not in SLOTS:
            raise Unreadable(f"{self.entry['name']} has a map of {slot}, which this program does not know: use luthier of its version, and bake anew")
        kind, default, whole, own, doc = SLOTS[slot]
        of_layer = own and (layer or not whole)
        need = NEEDS.get(slot, "slab_factor" if of_layer else None)
        if need in ("f0_place", "metallic_place"):
            if f"{self.prefix}_{need}" not in self.text.functions:
                return []
        elif need and not self.has(need, layer or 0 if of_layer else None):
            return []
        name = slot.replace("-", "_") if slot != "weight" else "coat_weight"
        name = f"{name}_{layer or 0}" if of_layer else name
        if default is None:
            default = {"f0": f"{f0_of(self.entry)}", "metallic": f"{uncoloured(self.entry)[1]}"}.get(slot, ", ".join(map(str, uncoloured(self.entry)[0])))
        line = (own if of_layer else whole).format(v=name, own=f"place.layers[{layer or 0}]", p=self.prefix)
        self.functions |= {called for called in self.text.functions if f"{called}(" in line}
        self.inputs.append(Input(name, kind, default, line, record, doc))
        return [line] if line else []

    def has(self, member, layer):
        """Whether the place, or that of a layer, has a member."""
        members = lambda name: {member: int(length or 0) for _, member, length in self.text.members(f"{self.text.type}{name}")}
        if layer is None:
            return member in members("Place")
        return layer < members("Place").get("layers", 0) and member in members("LayerPlace")


def f0_of(entry):
    """F0 of the dielectric on the diffuse base."""
    layer = entry["layers"][-2]
    return ", ".join(map(str, layer["f0"])) if layer.get("f0") else ", ".join([str(((layer["eta"] - 1) / (layer["eta"] + 1)) ** 2)] * 3)


def uncoloured(entry):
    """Colour and metal of a surface with a map of the other alone."""
    constants, layers = entry["constants"], entry["layers"]
    metallic = 1.0 if any(layer.get("is_metal") for layer in layers) else 0.0
    if constants.get("brightening"):
        return constants["brightening"]["base_color"], metallic
    if metallic or len(layers) < 2:
        return [1.0, 1.0, 1.0], metallic
    # Without metal, what the interface lets through decides the albedo of the base.
    passed = 0.96 * 20 / 21 / layers[-2]["eta"] ** 2
    return [albedo * passed / (1 - albedo * (1 - passed)) for albedo in layers[-1]["albedo"]], metallic
