# `test.gd` of the folder above for Godot 3.6, without `saved`: godot3 --path . --script test.gd -- LIST
extends SceneTree

const LuthierBake = preload("res://addons/luthier/luthier_bake.gd")

var ball = _ball(128, 64, true)
var bare = _ball(128, 64, false)
var bakes = {}
# Whether pictures are half floats of linear light.
var hdr = false


func _initialize():
	var file = File.new()
	file.open(OS.get_cmdline_args()[-1], File.READ)
	print("driver: ", VisualServer.get_video_adapter_name())
	for entry in JSON.parse(file.get_as_text()).result:
		hdr = entry.hdr
		if not entry.bake in bakes:
			bakes[entry.bake] = LuthierBake.new()
			bakes[entry.bake].open(entry.bake)
		if bakes[entry.bake].error == "":
			yield(call("_" + entry.kind, entry, bakes[entry.bake].material(entry.material)), "completed")
	quit()


func _picture(entry, material):
	material.set_shader_param("host_slope_variance", entry.slope_variance)
	var camera = Camera.new()
	camera.fov = entry.fov_y_deg
	camera.translation.z = entry.eye_distance
	var image = yield(_view(entry.size, [_mesh(ball if entry.tangents else bare, material), camera], entry.lights), "completed")
	image.save_png(entry.picture)


func _lamps(entry, material):
	var lights = {
		"directional": {"direction": [-1, 2, 1], "irradiance": [1.5, 1.4, 1.3]},
		"omni": {"position": [1.5, 2, 1.5], "irradiance": [0.5, 0.9, 0.5]},
		"spot": {"position": [-0.5, 3, 2], "irradiance": [1.0, 0.6, 0.6], "angle": 25},
	}
	var figures = {}
	var images = []
	for name in lights:
		var open = yield(_lamps_view(material, [lights[name]], false), "completed")
		images.append(yield(_lamps_view(material, [lights[name]], true), "completed"))
		var lit = 0
		var shadowed = 0
		for y in range(128):
			for x in range(128):
				var light = open.get_pixel(x, y).r
				lit += int(light > 0.01)
				shadowed += int(light > 0.01 and images[-1].get_pixel(x, y).r < 0.2 * light)
		figures[name] = [lit, shadowed]
	var all = yield(_lamps_view(material, lights.values(), true), "completed")
	var off = []
	for y in range(128):
		for x in range(128):
			var sum = 0.0
			for image in images:
				sum += image.get_pixel(x, y).r
			off.append(abs(sum - all.get_pixel(x, y).r) / max(sum, 0.01))
	off.sort()
	figures["off"] = off[int(0.99 * off.size())]
	print("lamps: ", JSON.print(figures))


func _lamps_view(material, lights, shadow):
	var floor_mesh = PlaneMesh.new()
	floor_mesh.size = Vector2(8, 8)
	var floor_node = _mesh(floor_mesh, material)
	floor_node.translation.y = -1
	var camera = Camera.new()
	camera.look_at_from_position(Vector3(0, 3, 5), Vector3.ZERO, Vector3.UP)
	var shown = []
	for light in lights:
		shown.append(light.duplicate())
		shown[-1].shadow = shadow
	var image = yield(_view(128, [_mesh(ball, material), floor_node, camera], shown), "completed")
	image.lock()
	return image


# A picture of nodes in black surroundings.
func _view(size, nodes, lights):
	var viewport = Viewport.new()
	viewport.size = Vector2(size, size)
	viewport.own_world = true
	viewport.keep_3d_linear = hdr
	viewport.shadow_atlas_size = 2048
	viewport.render_target_v_flip = true
	viewport.render_target_update_mode = Viewport.UPDATE_ALWAYS
	var surroundings = WorldEnvironment.new()
	surroundings.environment = Environment.new()
	surroundings.environment.background_mode = Environment.BG_COLOR
	surroundings.environment.background_color = Color.black
	root.add_child(viewport)
	for node in [surroundings] + nodes:
		viewport.add_child(node)
	for light in lights:
		_add_lamp(viewport, light)
	for frame in range(3):
		yield(self, "idle_frame")
	var image = viewport.get_texture().get_data()
	viewport.queue_free()
	return image


func _mesh(mesh, material):
	var made = MeshInstance.new()
	made.mesh = mesh
	made.material_override = material
	return made


# A lamp far away, or at a position, whose irradiance is that at the centre. Godot multiplies the energy by pi.
func _add_lamp(viewport, light):
	var lamp = SpotLight.new() if light.has("angle") else OmniLight.new() if light.has("position") else DirectionalLight.new()
	viewport.add_child(lamp)
	var at = _vector(light.get("position", light.get("direction")))
	lamp.look_at_from_position(at, Vector3.ZERO, Vector3.UP)
	var strength = _vector(light.irradiance)
	if lamp is OmniLight:
		strength *= at.length_squared()
		lamp.omni_attenuation = 2.0
		lamp.omni_range = 1000.0
	if lamp is SpotLight:
		strength *= at.length_squared()
		lamp.spot_attenuation = 2.0
		lamp.spot_range = 1000.0
		lamp.spot_angle = light.angle
	var most = strength[strength.max_axis()]
	lamp.light_energy = most / PI
	lamp.light_color = Color(_curve(strength.x / most), _curve(strength.y / most), _curve(strength.z / most))
	lamp.shadow_enabled = light.get("shadow", false)


# The sRGB curve, above its straight part.
func _curve(value):
	return 1.055 * pow(value, 1.0 / 2.4) - 0.055


func _vector(numbers):
	return Vector3(numbers[0], numbers[1], numbers[2])


# A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`.
func _ball(columns, rows, has_tangents):
	var made = SurfaceTool.new()
	made.begin(Mesh.PRIMITIVE_TRIANGLES)
	for row in range(rows + 1):
		for column in range(columns + 1):
			var phi = TAU * column / columns
			var theta = PI * row / rows
			var normal = Vector3(-cos(phi) * sin(theta), cos(theta), sin(phi) * sin(theta))
			made.add_normal(normal)
			if has_tangents:
				made.add_tangent(Plane(Vector3(sin(phi), 0, cos(phi)), 1.0))
			made.add_uv(Vector2(float(column) / columns + 0.25, float(row) / rows))
			made.add_vertex(normal)
	for row in range(rows):
		for column in range(columns):
			var a = row * (columns + 1) + column
			var b = a + columns + 1
			for index in [a, a + 1, b, a + 1, b + 1, b]:
				made.add_index(index)
	# Without flags: compressed normals have 8 bits.
	return made.commit(null, 0)
