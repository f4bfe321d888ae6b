# What keeps a manifest from being drawn with. The same file serves Godot 3.6 and 4.

# The version of the manifest that this addon reads, and the language of its shaders.
const SCHEMA = 4
const TARGET = "glsl-es300"

const Ktx2 = preload("ktx2.gd")


# What is wrong, and how to bake anew; empty where nothing is.
static func problem(manifest):
	var schema = manifest.get("schema")
	if schema == null:
		return "this is no manifest of luthier: it has no schema"
	if int(schema) != SCHEMA:
		return "the manifest has schema %d, and this addon reads %d: bake again with the luthier of the addon's version" % [int(schema), SCHEMA]
	if baked(manifest) == null:
		return "the bake has no baked shader in %s: bake with --target %s --form baked" % [TARGET, TARGET]
	if not "surface" in manifest.get("functions", []):
		return "the shader takes no normals and maps of a renderer: bake with --functions surface"
	if manifest.has("names") and manifest.names.prefix != "luthier":
		return "names in the shader begin with %s: bake without --prefix, because each bake has a shader of its own" % manifest.names.prefix
	for table in manifest.tables:
		if not table.format in Ktx2.FORMATS:
			return "the table %s has texels of %s, which Godot does not filter: bake with --layout filtered and --no-search" % [table.kind, table.format]
	return ""


# The entry of the baked shader; null where there is none.
static func baked(manifest):
	for entry in manifest.shaders:
		if entry.target == TARGET and entry.form == "baked":
			return entry
	return null
