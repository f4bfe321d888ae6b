# A bake of luthier in Godot 4: materials of the folder that `luthier bake --target glsl-es300 --form baked --functions surface` writes.
#
#     var bake := LuthierBake.open("res://bake")        # null where it cannot be drawn with; the error says why
#     mesh.material_override = bake.material("car-paint")
class_name LuthierBake
extends RefCounted

const Ktx2 := preload("ktx2.gd")
const Manifest := preload("manifest.gd")
const Surface := preload("surface.gd")
const Text := preload("shader.gd")

## What kept the last bake from being opened.
static var error := ""

## Names of the materials; the index is the number of a material in the shader.
var names: Array[String] = []
## The shader of all materials.
var shader := Shader.new()
var manifest: Dictionary

var _folder: String
var _surface
# Textures of tables and of the material buffer by uniform, and of maps by path.
var _tables := {}
var _maps := {}
var _materials := {}


## The bake in a folder, or null.
static func open(folder: String) -> LuthierBake:
	var bake := LuthierBake.new()
	error = bake._open(folder)
	if error:
		push_error(error)
		return null
	return bake


## A material by its name; null where there is none. It is one object: `duplicate()` it to change its parameters. `host_slope_variance` is the variance of
## the slopes of the normals that a pixel sees, along either axis: it widens highlights, as the size of a lamp does.
func material(name: String) -> ShaderMaterial:
	if not name in names:
		push_error("%s has no material %s; it has %s" % [_folder, name, ", ".join(names)])
		return null
	if not name in _materials:
		_materials[name] = _make(names.find(name))
	return _materials[name]


## Writes every material into a folder of the project, NAME.tres, with the shader and the textures beside it, which an exported game then has.
func save(folder: String) -> Error:
	var parts := {"shader": shader}
	for key: String in _tables:
		parts[key] = _tables[key]
	for key: String in _maps:
		parts[key.get_basename().replace("/", "-")] = _maps[key]
	for name: String in parts:
		var failed := ResourceSaver.save(parts[name], "%s/%s.res" % [folder, name], ResourceSaver.FLAG_COMPRESS | ResourceSaver.FLAG_CHANGE_PATH)
		if failed:
			return failed
	for name in names:
		var failed := ResourceSaver.save(material(name), "%s/%s.tres" % [folder, name])
		if failed:
			return failed
	return OK


func _make(number: int) -> ShaderMaterial:
	var entry: Dictionary = manifest.materials[number]
	var made := ShaderMaterial.new()
	made.resource_name = entry.name
	made.shader = shader
	var base: Array = _surface.base_of(entry)
	made.set_shader_parameter("host_material", number)
	made.set_shader_parameter("host_base", Vector4(base[0], base[1], base[2], base[3]))
	for key: String in _tables:
		made.set_shader_parameter(key, _tables[key])
	var maps: Array = _surface.maps_of(entry)
	for i in maps.size():
		if maps[i] == null:
			continue
		var rows: Array = Surface.rows_of(entry, maps[i])
		made.set_shader_parameter("host_map_%d" % i, _maps[maps[i].file.path])
		made.set_shader_parameter("host_is_srgb_%d" % i, maps[i].get("srgb", false))
		made.set_shader_parameter("host_kind_%d" % i, _surface.kind_of(maps[i]))
		made.set_shader_parameter("host_factor_%d" % i, _vector(maps[i].get("factor", [1.0, 1.0, 1.0])))
		made.set_shader_parameter("host_u_%d" % i, _vector(rows[0]))
		made.set_shader_parameter("host_v_%d" % i, _vector(rows[1]))
	return made


static func _vector(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])


# Reads the folder. The answer is what keeps it from being drawn with, and how to bake anew.
func _open(folder: String) -> String:
	_folder = folder
	var file := folder.path_join("manifest.json")
	if not FileAccess.file_exists(file):
		return "%s is no bake: it has no manifest.json" % folder
	var json := JSON.new()
	if json.parse(FileAccess.get_file_as_string(file)) or not json.data is Dictionary:
		return "%s is no JSON: bake again" % file
	manifest = json.data
	var wrong: String = Manifest.problem(manifest)
	if wrong:
		return "%s: %s" % [file, wrong]
	var baked: Dictionary = Manifest.baked(manifest)
	var glsl := FileAccess.get_file_as_string(folder.path_join(baked.file.path))
	_surface = Surface.new(manifest, baked.interface, glsl)
	if _surface.error:
		return "%s: %s" % [file, _surface.error]
	var nearest := ["luthier_materials"]
	for table: Dictionary in manifest.tables:
		var texels = Ktx2.read(FileAccess.get_file_as_bytes(folder.path_join(table.texture.path)), table.format)
		if texels == null:
			return "%s is no whole KTX2 file: bake again" % folder.path_join(table.texture.path)
		_tables["luthier_" + table.kind] = _texture(texels)
		if table.format.ends_with("32float"):
			nearest.append("luthier_" + table.kind)
	var size: Dictionary = manifest.material_texture
	var words := FileAccess.get_file_as_bytes(folder.path_join(manifest.material_buffer.path))
	if words.size() != 16 * size.width * size.height:
		return "%s has not the size that the manifest says: bake again" % folder.path_join(manifest.material_buffer.path)
	_tables["luthier_materials"] = _texture([size.width, size.height, Image.FORMAT_RGBAF, words])
	for entry: Dictionary in manifest.materials:
		names.append(entry.name)
		for map: Dictionary in entry.maps:
			var image := Image.load_from_file(folder.path_join(map.file.path))
			if image == null:
				return "%s cannot be read: bake again" % folder.path_join(map.file.path)
			image.generate_mipmaps()
			_maps[map.file.path] = ImageTexture.create_from_image(image)
	shader.code = Text.text_of(glsl, _surface, nearest, 4)
	return "" if shader.get_shader_uniform_list() else "%s: Godot does not take the shader" % file


static func _texture(texels: Array) -> ImageTexture:
	return ImageTexture.create_from_image(Image.create_from_data(texels[0], texels[1], false, texels[2], texels[3]))
