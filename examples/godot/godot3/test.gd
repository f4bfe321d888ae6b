# `test.gd` of the folder above for Godot 3.6: godot3 --path . --script test.gd -- LIST, which the environment variable LIST may name, too.
extends SceneTree

const LuthierBake = preload("res://addons/luthier/luthier_bake.gd")

var ball = _ball(128, 64)
var bakes = {}


func _initialize():
	var file = File.new()
	file.open(OS.get_cmdline_args()[-1], File.READ)
	for entry in JSON.parse(file.get_as_text()).result:
		var drawn = _draw(entry)
		if drawn is GDScriptFunctionState:
			yield(drawn, "completed")
	quit()


func _draw(entry):
	if not entry.bake in bakes:
		bakes[entry.bake] = LuthierBake.new()
		if bakes[entry.bake].open(entry.bake) != OK:
			return
	var material = bakes[entry.bake].material(entry.material)
	material.set_shader_param("host_slope_variance", entry.slope_variance)
	var viewport = Viewport.new()
	viewport.size = Vector2(entry.size, entry.size)
	viewport.own_world = true
	viewport.render_target_v_flip = true
	viewport.render_target_update_mode = Viewport.UPDATE_ALWAYS
	root.add_child(viewport)
	var surroundings = WorldEnvironment.new()
	surroundings.environment = Environment.new()
	surroundings.environment.background_mode = Environment.BG_COLOR
	surroundings.environment.background_color = Color.black
	viewport.add_child(surroundings)
	var mesh = MeshInstance.new()
	mesh.mesh = ball
	mesh.material_override = material
	viewport.add_child(mesh)
	for light in entry.lights:
		_add_lamp(viewport, light)
	var camera = Camera.new()
	camera.fov = entry.fov_y_deg
	camera.translation.z = entry.eye_distance
	viewport.add_child(camera)
	for frame in range(3):
		yield(self, "idle_frame")
	viewport.get_texture().get_data().save_png(entry.picture)
	viewport.queue_free()


# A lamp far away, or at a position, whose irradiance is that at the centre. Godot multiplies the energy by pi.
func _add_lamp(viewport, light):
	var lamp = OmniLight.new() if light.has("position") else DirectionalLight.new()
	viewport.add_child(lamp)
	var at = _vector(light.get("position", light.get("direction")))
	lamp.look_at_from_position(at, Vector3.ZERO, Vector3.UP)
	var strength = _vector(light.irradiance)
	if lamp is OmniLight:
		strength *= at.length_squared()
		lamp.omni_attenuation = 2.0
		lamp.omni_range = 1000.0
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
func _ball(columns, rows):
	var made = SurfaceTool.new()
	made.begin(Mesh.PRIMITIVE_TRIANGLES)
	for row in range(rows + 1):
		for column in range(columns + 1):
			var phi = TAU * column / columns
			var theta = PI * row / rows
			var normal = Vector3(-cos(phi) * sin(theta), cos(theta), sin(phi) * sin(theta))
			made.add_normal(normal)
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
