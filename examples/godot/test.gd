# Draws what a file of JSON lists, for test.mjs: godot --path . --script test.gd -- LIST. Each entry names a bake, a material, lamps and a PNG file.
extends SceneTree

var ball := _ball(128, 64)
var bakes := {}


func _initialize() -> void:
	var list: Array = JSON.parse_string(FileAccess.get_file_as_string(OS.get_cmdline_user_args()[0]))
	print("driver: ", RenderingServer.get_video_adapter_name())
	for entry: Dictionary in list:
		if not await _draw(entry):
			quit(1)
			return
	quit()


func _draw(entry: Dictionary) -> bool:
	if not entry.bake in bakes:
		bakes[entry.bake] = LuthierBake.open(entry.bake)
	if bakes[entry.bake] == null:
		return false
	var material: ShaderMaterial = bakes[entry.bake].material(entry.material)
	material.set_shader_parameter("luthier_slope_variance", entry.slope_variance)
	var viewport := SubViewport.new()
	viewport.size = Vector2i(entry.size, entry.size)
	viewport.own_world_3d = true
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	root.add_child(viewport)
	var surroundings := WorldEnvironment.new()
	surroundings.environment = Environment.new()
	surroundings.environment.background_mode = Environment.BG_COLOR
	surroundings.environment.background_color = Color.BLACK
	viewport.add_child(surroundings)
	var mesh := MeshInstance3D.new()
	mesh.mesh = ball
	mesh.material_override = material
	viewport.add_child(mesh)
	for light: Dictionary in entry.lights:
		viewport.add_child(_lamp(light))
	var camera := Camera3D.new()
	camera.fov = entry.fov_y_deg
	camera.position.z = entry.eye_distance
	viewport.add_child(camera)
	for frame in 4:
		await process_frame
	viewport.get_texture().get_image().save_png(entry.picture)
	viewport.queue_free()
	return true


## A lamp far away, or at a position, whose irradiance is that at the centre. Godot multiplies the energy by pi.
func _lamp(light: Dictionary) -> Light3D:
	var lamp: Light3D = OmniLight3D.new() if light.has("position") else DirectionalLight3D.new()
	var at := _vector(light.get("position", light.get("direction")))
	lamp.look_at_from_position(at, Vector3.ZERO)
	var strength := _vector(light.irradiance)
	if lamp is OmniLight3D:
		strength *= at.length_squared()
		lamp.omni_attenuation = 2.0
		lamp.omni_range = 1000.0
	lamp.light_energy = strength[strength.max_axis_index()] / PI
	strength /= strength[strength.max_axis_index()]
	lamp.light_color = Color(strength.x, strength.y, strength.z).linear_to_srgb()
	lamp.shadow_enabled = light.get("shadow", false)
	return lamp


func _vector(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])


## A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`.
func _ball(columns: int, rows: int) -> ArrayMesh:
	var made := SurfaceTool.new()
	made.begin(Mesh.PRIMITIVE_TRIANGLES)
	for row in rows + 1:
		for column in columns + 1:
			var phi := TAU * column / columns
			var theta := PI * row / rows
			var normal := Vector3(-cos(phi) * sin(theta), cos(theta), sin(phi) * sin(theta))
			made.set_normal(normal)
			made.set_tangent(Plane(Vector3(sin(phi), 0, cos(phi)), 1.0))
			made.set_uv(Vector2(float(column) / columns + 0.25, float(row) / rows))
			made.add_vertex(normal)
	for row in rows:
		for column in columns:
			var a := row * (columns + 1) + column
			var b := a + columns + 1
			for index in [a, a + 1, b, a + 1, b + 1, b]:
				made.add_index(index)
	return made.commit()
