# Does what a file of JSON lists, for test.mjs: godot --path . --script test.gd -- LIST. Each entry names a `bake` and a `material`, and is of a `kind`:
# - picture: the ball under `lights`, as a PNG file.
# - lamps: a ball on a floor under three kinds of lamps; prints what is lit, what is in shadow, and whether lamps add up.
# - saved: as a picture, with a material that was saved as a resource and read again.
extends SceneTree

var ball := _ball(128, 64)
var bare := _ball(128, 64, false)
var bakes := {}
## Whether pictures are half floats of linear light.
var hdr := false


func _initialize() -> void:
	var list: Array = JSON.parse_string(FileAccess.get_file_as_string(OS.get_cmdline_user_args()[0]))
	print("driver: ", RenderingServer.get_video_adapter_name())
	for entry: Dictionary in list:
		if not entry.bake in bakes:
			bakes[entry.bake] = LuthierBake.open(entry.bake)
		hdr = entry.hdr
		if bakes[entry.bake]:
			await call("_" + entry.kind, entry, bakes[entry.bake].material(entry.material))
	quit()


func _picture(entry: Dictionary, material: ShaderMaterial) -> void:
	material.set_shader_parameter("host_slope_variance", entry.slope_variance)
	var camera := Camera3D.new()
	camera.fov = entry.fov_y_deg
	camera.position.z = entry.eye_distance
	var image := await _view(entry.size, [_mesh(ball if entry.tangents else bare, material), camera] + entry.lights.map(_lamp))
	if hdr:
		for y in image.get_height():
			for x in image.get_width():
				image.set_pixel(x, y, image.get_pixel(x, y).clamp().linear_to_srgb())
		image.convert(Image.FORMAT_RGB8)
	image.save_png(entry.picture)


func _saved(entry: Dictionary, _material: ShaderMaterial) -> void:
	DirAccess.make_dir_recursive_absolute(entry.folder)
	print("saved: ", error_string(bakes[entry.bake].save(entry.folder)))
	bakes.clear()
	await _picture(entry, load("%s/%s.tres" % [entry.folder, entry.material]))


func _lamps(entry: Dictionary, material: ShaderMaterial) -> void:
	var floor_mesh := PlaneMesh.new()
	floor_mesh.size = Vector2(8, 8)
	var lights := {
		"directional": {"direction": [-1, 2, 1], "irradiance": [1.5, 1.4, 1.3]},
		"omni": {"position": [1.5, 2, 1.5], "irradiance": [0.5, 0.9, 0.5]},
		"spot": {"position": [-0.5, 3, 2], "irradiance": [1.0, 0.6, 0.6], "angle": 25},
	}
	var view := func(names: Array, shadow: bool) -> Image:
		var camera := Camera3D.new()
		camera.look_at_from_position(Vector3(0, 3, 5), Vector3.ZERO)
		var floor_node := _mesh(floor_mesh, material)
		floor_node.position.y = -1
		var lamps := names.map(func(name): return _lamp(lights[name].merged({"shadow": shadow})))
		return await _view(128, [_mesh(ball, material), floor_node, camera] + lamps)
	var figures := {}
	var images := []
	for name: String in lights:
		var open: Image = await view.call([name], false)
		images.append(await view.call([name], true))
		var lit := 0
		var shadowed := 0
		for y in 128:
			for x in 128:
				var light := open.get_pixel(x, y).r
				lit += int(light > 0.01)
				shadowed += int(light > 0.01 and images[-1].get_pixel(x, y).r < 0.2 * light)
		figures[name] = [lit, shadowed]
	var all: Image = await view.call(lights.keys(), true)
	var off := []
	for y in 128:
		for x in 128:
			var sum := Color(0, 0, 0)
			for image: Image in images:
				sum += image.get_pixel(x, y)
			off.append(abs(sum.r - all.get_pixel(x, y).r) / max(sum.r, 0.01))
	off.sort()
	figures["off"] = off[int(0.99 * off.size())]
	print("lamps: ", JSON.stringify(figures))


## A picture of nodes in black surroundings.
func _view(size: int, nodes: Array) -> Image:
	var viewport := SubViewport.new()
	viewport.size = Vector2i(size, size)
	viewport.own_world_3d = true
	viewport.use_hdr_2d = hdr
	viewport.render_target_update_mode = SubViewport.UPDATE_ALWAYS
	var surroundings := WorldEnvironment.new()
	surroundings.environment = Environment.new()
	surroundings.environment.background_mode = Environment.BG_COLOR
	surroundings.environment.background_color = Color.BLACK
	root.add_child(viewport)
	for node: Node in [surroundings] + nodes:
		viewport.add_child(node)
	for frame in 4:
		await process_frame
	var image := viewport.get_texture().get_image()
	viewport.queue_free()
	return image


func _mesh(mesh: Mesh, material: Material) -> MeshInstance3D:
	var made := MeshInstance3D.new()
	made.mesh = mesh
	made.material_override = material
	return made


## A lamp far away, or at a position, whose irradiance is that at the centre. Godot multiplies the energy by pi.
func _lamp(light: Dictionary) -> Light3D:
	var lamp: Light3D = SpotLight3D.new() if light.has("angle") else OmniLight3D.new() if light.has("position") else DirectionalLight3D.new()
	var at := _vector(light.get("position", light.get("direction")))
	lamp.look_at_from_position(at, Vector3.ZERO)
	var strength := _vector(light.irradiance)
	if lamp is OmniLight3D:
		strength *= at.length_squared()
		lamp.omni_attenuation = 2.0
		lamp.omni_range = 1000.0
	if lamp is SpotLight3D:
		strength *= at.length_squared()
		lamp.spot_attenuation = 2.0
		lamp.spot_range = 1000.0
		lamp.spot_angle = light.angle
	lamp.light_energy = strength[strength.max_axis_index()] / PI
	strength /= strength[strength.max_axis_index()]
	lamp.light_color = Color(strength.x, strength.y, strength.z).linear_to_srgb()
	lamp.shadow_enabled = light.get("shadow", false)
	return lamp


func _vector(numbers: Array) -> Vector3:
	return Vector3(numbers[0], numbers[1], numbers[2])


## A ball whose texture coordinates begin at the top, behind: those of `luthier preview --shape sphere`.
func _ball(columns: int, rows: int, has_tangents := true) -> ArrayMesh:
	var made := SurfaceTool.new()
	made.begin(Mesh.PRIMITIVE_TRIANGLES)
	for row in rows + 1:
		for column in columns + 1:
			var phi := TAU * column / columns
			var theta := PI * row / rows
			var normal := Vector3(-cos(phi) * sin(theta), cos(theta), sin(phi) * sin(theta))
			made.set_normal(normal)
			if has_tangents:
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
