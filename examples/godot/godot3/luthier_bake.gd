# A bake of luthier in Godot 3.6: `addons/luthier/luthier_bake.gd` for the older engine. Copy the folder of the addon, and this file over the one there.
#
#     var bake = LuthierBake.new()
#     if bake.open("res://bake") == OK:                 # the error says why not, and is in `bake.error`, too
#         mesh.material_override = bake.material("car-paint")
class_name LuthierBake
extends Reference

const Ktx2 = preload("res://addons/luthier/ktx2.gd")
const Manifest = preload("res://addons/luthier/manifest.gd")
const Surface = preload("res://addons/luthier/surface.gd")
const Text = preload("res://addons/luthier/shader.gd")

# What kept the bake from being opened.
var error = ""
# Names of the materials; the index is the number of a material in the shader.
var names = []
# The shader of all materials.
var shader = Shader.new()
var manifest = {}

var _folder
var _surface
# Textures of tables and of the material buffer by uniform, and of maps by path.
var _tables = {}
var _maps = {}
var _materials = {}


func open(folder):
	error = _open(folder)
	if error == "":
		return OK
	push_error(error)
	return ERR_INVALID_DATA


# A material by its name; null where there is none. It is one object: `duplicate()` it to change its parameters.
func material(name):
	if not name in names:
		push_error("%s has no material %s; it has %s" % [_folder, name, PoolStringArray(names).join(", ")])
		return null
	if not name in _materials:
		_materials[name] = _make(names.find(name))
	return _materials[name]


func _make(number):
	var entry = manifest.materials[number]
	var made = ShaderMaterial.new()
	made.resource_name = entry.name
	made.shader = shader
	var base = _surface.base_of(entry)
	made.set_shader_param("host_material", number)
	made.set_shader_param("host_base", Plane(base[0], base[1], base[2], base[3]))
	for key in _tables:
		made.set_shader_param(key, _tables[key])
	var maps = _surface.maps_of(entry)
	for i in range(maps.size()):
		if maps[i] == null:
			continue
		var rows = Surface.rows_of(entry, maps[i])
		made.set_shader_param("host_map_%d" % i, _maps[maps[i].file.path])
		made.set_shader_param("host_is_srgb_%d" % i, maps[i].get("srgb", false))
		made.set_shader_param("host_kind_%d" % i, _surface.kind_of(maps[i]))
		made.set_shader_param("host_factor_%d" % i, _vector(maps[i].get("factor", [1.0, 1.0, 1.0])))
		made.set_shader_param("host_u_%d" % i, _vector(rows[0]))
		made.set_shader_param("host_v_%d" % i, _vector(rows[1]))
	return made


static func _vector(numbers):
	return Vector3(numbers[0], numbers[1], numbers[2])


# Reads the folder. The answer is what keeps it from being drawn with, and how to bake anew.
func _open(folder):
	_folder = folder
	var path = folder.plus_file("manifest.json")
	var file = File.new()
	if not file.file_exists(path):
		return "%s is no bake: it has no manifest.json" % folder
	var json = JSON.parse(_bytes(path).get_string_from_utf8())
	if json.error or typeof(json.result) != TYPE_DICTIONARY:
		return "%s is no JSON: bake again" % path
	manifest = json.result
	var wrong = Manifest.problem(manifest)
	if wrong:
		return "%s: %s" % [path, wrong]
	var baked = Manifest.baked(manifest)
	var glsl = _bytes(folder.plus_file(baked.file.path)).get_string_from_utf8()
	_surface = Surface.new(manifest, baked.interface, glsl)
	if _surface.error:
		return "%s: %s" % [path, _surface.error]
	for table in manifest.tables:
		var texels = Ktx2.read(_bytes(folder.plus_file(table.texture.path)), table.format)
		if texels == null:
			return "%s is no whole KTX2 file: bake again" % folder.plus_file(table.texture.path)
		_tables["luthier_" + table.kind] = _texture(texels, 0 if table.format.ends_with("32float") else Texture.FLAG_FILTER)
	var size = manifest.material_texture
	var words = _bytes(folder.plus_file(manifest.material_buffer.path))
	if words.size() != 16 * size.width * size.height:
		return "%s has not the size that the manifest says: bake again" % folder.plus_file(manifest.material_buffer.path)
	_tables["luthier_materials"] = _texture([size.width, size.height, Image.FORMAT_RGBAF, words], 0)
	for entry in manifest.materials:
		names.append(entry.name)
		for map in entry.maps:
			var image = Image.new()
			if image.load_png_from_buffer(_bytes(folder.plus_file(map.file.path))):
				return "%s cannot be read: bake again" % folder.plus_file(map.file.path)
			var texture = ImageTexture.new()
			var flags = Texture.FLAG_REPEAT | Texture.FLAG_FILTER | Texture.FLAG_MIPMAPS
			texture.create_from_image(image, Texture.FLAG_REPEAT if map.slot == "flake-normal" else flags)
			_maps[map.file.path] = texture
	shader.code = Text.text_of(glsl, _surface, [], 3)
	return "" if VisualServer.shader_get_param_list(shader.get_rid()) else "%s: Godot does not take the shader" % path


static func _bytes(path):
	var file = File.new()
	if file.open(path, File.READ):
		return PoolByteArray()
	return file.get_buffer(file.get_len())


static func _texture(texels, flags):
	var image = Image.new()
	image.create_from_data(texels[0], texels[1], false, texels[2], texels[3])
	var texture = ImageTexture.new()
	texture.create_from_image(image, flags)
	return texture
