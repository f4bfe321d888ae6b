# The maps of materials, and the lines of shader that fill a `LuthierPlace` from their texels. The lines are the same for all materials of a bake: a texel
# goes to the quantity whose number, its kind, is a uniform. So a bake has one shader. The same file serves Godot 3.6 and 4.

# What the texel `t` of a map says of the place: the table in docs/manifest.md. Where a line needs a member of the place, of the place of a layer, or a
# function, that is its second half; without it no model of the bake shows the quantity.
const SLOTS = {
	"normal": ["here.normal = host_unit_normal(t);", ""],
	"roughness": ["here.alpha_factor = t.x * t.x;", ""],
	"thickness": ["here.slab_factor = t.x;", ""],
	"weight": ["here.weight_factor = t.x;", "weight_factor"],
	"patina": ["here.patina = luthier_patina_amount(material, t.x);", "patina"],
	"flake-normal": ["here.flake_normal = luthier_flake_tilt(material, 2.0 * t - 1.0, far);", "flake_normal"],
	"albedo": ["here.base_color = t;", "base_color"],
	"lean": ["here.inner_normal = host_lean(host_unit_normal(t), here.inner_normal);", "inner_normal"],
	"f0": ["here = luthier_f0_place(here, material, t);", "luthier_f0_place"],
	# They take effect together, in the end.
	"base-color": ["base = vec4(t, base.w);", "luthier_metallic_place"],
	"metallic": ["base.w = t.x;", "luthier_metallic_place"],
}
const LAYER_SLOTS = {
	"thickness": ["here.layers[%d].slab_factor = t.x;", "slab_factor"],
	"absorption": ["here.layers[%d].absorption_factors = t;", "absorption_factors"],
	"bumps": ["here.layers[%d].normal = host_unit_normal(t);", "normal"],
	"alpha": ["here.layers[%d].alpha_factors *= t.x;", "alpha_factors"],
	"alpha-x": ["here.layers[%d].alpha_factors.x *= t.x;", "alpha_factors"],
	"alpha-y": ["here.layers[%d].alpha_factors.y *= t.x;", "alpha_factors"],
	"tangent": ["here.layers[%d].tangent = luthier_tangent(t.xy);", "tangent"],
}

# How Godot filters a texture, in the order of the texture uniforms: in 4 by words of the uniform, in 3.6 by flags of the texture.
const READS = ["linear", "cells"]

# Why a map is not known; empty where all are.
var error = ""
# Lines of the kinds from 1 up, and which they are: "slot layer".
var lines = []
var kinds = []
# How each texture that a material may have is read.
var reads = []
# Statements before the maps and behind them. They read `material`, `uv` and `far`, the distance of the eye.
var before = ""
var after = ""

var _functions = []
var _members = {}
var _layers = 0


func _init(manifest, known, text):
	for function in known.functions:
		_functions.append(function.name)
	for structure in known.structures:
		_members[structure.name] = structure.members
	var layers = RegEx.new()
	layers.compile("LuthierLayerPlace layers\\[(\\d+)")
	var found = layers.search(text)
	if found:
		_layers = int(found.get_string(1))
	for entry in manifest.materials:
		for map in entry.maps:
			_add(entry.name, map)
	for read in READS:
		var most = 0
		for entry in manifest.materials:
			most = max(most, _maps_read(entry, read).size())
		for i in range(most):
			reads.append(read)
	if has("luthier_film_place"):
		before += "here = luthier_film_place(here, material, uv);\n"
	if has("luthier_flake_normal"):
		before += "here.flake_normal = luthier_flake_normal(material, uv, far);\n"
	if has("luthier_metallic_place"):
		after += "if (base.w >= 0.0) { here = luthier_metallic_place(here, material, base.xyz, base.w); }\n"
	if has("luthier_glitter_normal"):
		after += "if (luthier_glitter_normal(material, uv).z < 1.0) { here.normal = luthier_glitter_normal(material, uv); }\n"


# Whether the shader has a function.
func has(name):
	return name in _functions


# The map in each of the textures of a material; null where it has none.
func maps_of(entry):
	var all = []
	for read in READS:
		var maps = _maps_read(entry, read)
		for i in range(reads.count(read)):
			all.append(maps[i] if i < maps.size() else null)
	return all


# Number of the kind of a map; 0 for none.
func kind_of(map):
	return 0 if map == null else kinds.find(_key(map)) + 1


# Colour and metal of a surface with a map of the other alone, which the maps overwrite; metal below 0 for a surface with neither.
func base_of(entry):
	var is_mapped = false
	for map in entry.maps:
		is_mapped = is_mapped or (map.slot in ["base-color", "metallic"] and _key(map) in kinds)
	if not is_mapped:
		return [0.0, 0.0, 0.0, -1.0]
	var metallic = 0.0
	for layer in entry.layers:
		if layer.get("is_metal", false):
			metallic = 1.0
	if entry.constants.get("brightening") != null:
		return entry.constants.brightening.base_color + [metallic]
	# Without metal, what the interface lets through decides the albedo of the base.
	var passed = 0.96 * 20.0 / 21.0 / pow(entry.layers[-2].eta, 2.0)
	var base = []
	for albedo in entry.layers[-1].albedo:
		base.append(albedo * passed / (1.0 - albedo * (1.0 - passed)))
	return base + [metallic]


# Rows that make the texture coordinates of a map of (u, v, 1).
static func rows_of(entry, map):
	var rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
	if map == null:
		return rows
	rows = map.get("transform", rows)
	var tiling = entry.constants.flakes.tiling if map.slot == "flake-normal" else 1.0
	var tiled = []
	for row in rows:
		tiled.append([row[0] * tiling, row[1] * tiling, row[2]])
	return tiled


static func read_of(map):
	return "cells" if map.slot == "flake-normal" else "linear"


static func _key(map):
	return "%s %s" % [map.slot, map.layer]


func _add(name, map):
	var layer = int(map.layer) if map.layer != null else 0
	var of_layer = map.slot in LAYER_SLOTS and (layer > 0 or not map.slot in SLOTS)
	if not of_layer and not map.slot in SLOTS:
		error = "%s has a map of %s, which this addon does not know" % [name, map.slot]
		return
	var line = LAYER_SLOTS[map.slot] if of_layer else SLOTS[map.slot]
	var structure = "LuthierLayerPlace" if of_layer else "LuthierPlace"
	var needs = line[1]
	var shown = needs == "" or has(needs) or (needs in _members.get(structure, []) and (not of_layer or layer < _layers))
	if shown and not _key(map) in kinds:
		kinds.append(_key(map))
		lines.append(line[0] % layer if of_layer else line[0])


# The maps of a material that its model shows and that are read so. An F0 comes last: it may depend on the weight of the coat above.
func _maps_read(entry, read):
	var maps = []
	var last = []
	for map in entry.maps:
		if _key(map) in kinds and read_of(map) == read:
			(last if map.slot == "f0" else maps).append(map)
	return maps + last
