# The spatial shader of a bake: its text in GLSL ES 3.00, which Godot's language takes but for the declarations of textures, and the two functions that call
# it. fragment() fills the place from the maps, light() asks for each lamp. Godot has no global variables, varyings are no structures, and few: the numbers of
# the place go to light() four by four, and it prepares them for the eye. Names of its own begin with host_. The same file serves Godot 3.6 and 4.

# Words of a texture uniform in Godot 4, by how it is read. In 3.6 filters are flags of the texture.
const HINTS_4 = {
	"table": " : filter_linear, repeat_disable",
	"words": " : filter_nearest, repeat_disable",
	"linear": " : filter_linear_mipmap_anisotropic, repeat_enable, hint_default_white",
	"cells": " : filter_nearest, repeat_enable, hint_default_white",
}
const HINTS_3 = {"table": "", "words": "", "linear": " : hint_white", "cells": " : hint_white"}


# The text, of the bake's GLSL and its `surface`. `nearest` names the tables that are not filtered.
static func text_of(glsl, surface, nearest, version):
	var hints = HINTS_4 if version >= 4 else HINTS_3
	var uniforms = ""
	var texels = ""
	for i in range(surface.reads.size()):
		uniforms += "uniform sampler2D host_map_%d%s;\nuniform bool host_is_srgb_%d = false;\n" % [i, hints[surface.reads[i]], i]
		uniforms += "uniform int host_kind_%d = 0;\nuniform vec3 host_factor_%d = vec3(1.0);\n" % [i, i]
		uniforms += "uniform vec3 host_u_%d = vec3(1.0, 0.0, 0.0);\nuniform vec3 host_v_%d = vec3(0.0, 1.0, 0.0);\n" % [i, i]
		texels += "\tkind = host_kind_%d;\n" % i
		texels += "\tt = texture(host_map_%d, vec2(dot(host_u_%d, vec3(uv, 1.0)), dot(host_v_%d, vec3(uv, 1.0)))).rgb;\n" % [i, i, i]
		texels += "\tt = host_factor_%d * (host_is_srgb_%d ? host_linear(t) : t);\n" % [i, i]
		for k in range(surface.lines.size()):
			texels += "\tif (kind == %d) { %s }\n" % [k + 1, surface.lines[k]]
	var numbers = _numbers("LuthierPlace", "here", _structures(glsl))
	var varyings = ""
	var sent = ""
	var received = ""
	for i in range(0, numbers.size(), 4):
		var four = ""
		for k in range(4):
			var is_there = i + k < numbers.size()
			four += (", " if k else "") + (numbers[i + k] if is_there else "0.0")
			if is_there:
				received += "\t%s = received_%d.%s;\n" % [numbers[i + k], i, "xyzw"[k]]
		varyings += "varying vec4 host_sent_%d;\n" % i
		sent += "\thost_sent_%d = vec4(%s);\n" % [i, four]
		received = "\tvec4 received_%d = host_sent_%d;\n" % [i, i] + received
	var lit = "color * luthier_light(prepared, direction)"
	if surface.has("luthier_light_lit"):
		lit = "luthier_light_lit(prepared, direction, color)"
	return TEXT.format({
		"glsl": _declared(glsl, hints, nearest), "uniforms": uniforms, "before": surface.before, "texels": texels, "after": surface.after,
		"varyings": varyings, "sent": sent, "received": received, "lit": lit,
	}, "<_>")


# The GLSL with the textures as Godot declares them.
static func _declared(glsl, hints, nearest):
	var declaration = RegEx.new()
	declaration.compile("uniform highp sampler2D (\\w+);")
	for found in declaration.search_all(glsl):
		var name = found.get_string(1)
		var hint = hints["words" if name in nearest else "table"]
		glsl = glsl.replace(found.get_string(), "uniform sampler2D %s%s;" % [name, hint])
	# Godot 3.6 would write the first as a decrement.
	return glsl.replace("- -", "+ ")


# Members of each structure, with their types: [type, name, number of elements or 0].
static func _structures(glsl):
	var comments = RegEx.new()
	comments.compile("//[^\\n]*")
	var structure = RegEx.new()
	structure.compile("struct (\\w+) \\{([^}]*)\\}")
	var member = RegEx.new()
	member.compile("(\\w+) (\\w+)(?:\\[(\\d+)\\])?;")
	var all = {}
	for found in structure.search_all(comments.sub(glsl, "", true)):
		var members = []
		for line in member.search_all(found.get_string(2)):
			members.append([line.get_string(1), line.get_string(2), int(line.get_string(3))])
		all[found.get_string(1)] = members
	return all


# All numbers of a variable, which are floats and vectors of them.
static func _numbers(type, path, structures):
	if type == "float":
		return [path]
	var all = []
	if type in ["vec2", "vec3", "vec4"]:
		for i in range(int(type[3])):
			all.append("%s.%s" % [path, "xyzw"[i]])
		return all
	for member in structures[type]:
		var inner = "%s.%s" % [path, member[1]]
		if member[2] == 0:
			all += _numbers(member[0], inner, structures)
		for i in range(member[2]):
			all += _numbers(member[0], "%s[%d]" % [inner, i], structures)
	return all


const TEXT = """shader_type spatial;
render_mode ambient_light_disabled;

<glsl>
uniform int host_material = 0;
uniform float host_slope_variance = 0.0;
uniform vec4 host_base = vec4(0.0, 0.0, 0.0, -1.0);
<uniforms>
varying vec4 host_tangent;
<varyings>
vec3 host_unit_normal(vec3 t) {
	vec3 n = 2.0 * t - 1.0;
	return normalize(vec3(n.xy, max(n.z, 0.001)));
}

// Colours of a texture. By its own hint for them the renderer Compatibility leaves them as they are.
vec3 host_linear(vec3 t) {
	return mix(pow((t + 0.055) / 1.055, vec3(2.4)), t / 12.92, lessThanEqual(t, vec3(0.04045)));
}

// Slopes add up.
vec3 host_lean(vec3 own, vec3 film) {
	return normalize(vec3(film.xy * own.z + own.xy * film.z, film.z * own.z));
}

// Tangent, and side of the bitangent. A mesh without tangents gets some: Godot says nothing of it, and has no normal maps there either.
vec4 host_make_tangent(vec3 normal, vec3 given, vec3 given_across) {
	vec3 along = given - normal * dot(normal, given);
	vec3 across = cross(normal, abs(normal.x) > 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0));
	float side = dot(cross(normal, given), given_across) < 0.0 ? -1.0 : 1.0;
	return vec4(normalize(dot(along, along) > 1e-6 ? along : across), side);
}

// What the maps say of the place.
LuthierPlace host_fill(uint material, vec2 uv, float far) {
	LuthierPlace here = luthier_place();
	here.slope_variance = host_slope_variance;
	vec4 base = host_base;
	int kind;
	vec3 t;
<before><texels><after>	return here;
}

// No normal is seen from behind.
vec3 host_seen(vec3 normal, vec3 wo) {
	return normalize(normal + max(0.02 - dot(normal, wo), 0.0) * wo);
}

void fragment() {
	vec3 normal = host_seen(NORMAL, VIEW);
	host_tangent = host_make_tangent(normal, TANGENT, BINORMAL);
	LuthierPlace here = host_fill(uint(host_material), UV, length(VERTEX));
<sent>}

void light() {
	LuthierPlace here;
<received>	vec3 normal = host_seen(NORMAL, VIEW);
	mat3 frame = mat3(host_tangent.xyz, cross(normal, host_tangent.xyz) * host_tangent.w, normal);
	LuthierPrepared prepared = luthier_prepare_at(here, uint(host_material), VIEW * frame);
	// The colour of a lamp has the factor pi that makes it an irradiance.
	vec3 color = LIGHT_COLOR * ATTENUATION;
	vec3 direction = LIGHT * frame;
	SPECULAR_LIGHT += min(<lit>, vec3(65504.0));
}
"""
