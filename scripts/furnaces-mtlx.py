#!/usr/bin/env python3
"""White furnaces of imported MaterialX files beside the shaders that MaterialX generates: a page in Markdown, docs/pages/materialx.md.

    python3 -m venv .venv && .venv/bin/pip install materialx==1.39.5
    .venv/bin/python scripts/furnaces-mtlx.py LUTHIER docs/pages/materialx.md

MaterialX makes a shader of each file in GLSL ES; Chromium (by the variable CHROMIUM) runs it in WebGL 2 under a white environment. `luthier import` makes
a material file of the same file, whose stack `luthier eval --model layered-mc` simulates. Nothing of the two ways is shared. Fails where a metal or a plastic
that means the same thing in both is more than .025 apart up to 60 degrees."""

import http.server
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import threading

ANGLES = [0, 30, 60, 75, 85]
# The most that materials of one meaning may be apart up to 60 degrees, and their kinds.
APART = 0.025
SAME = {"metal", "plastic"}
# Directions that a shader samples of its environment, and paths of the simulation.
SAMPLES, PATHS = 4096, 200000
# Longest wait for the browser, which compiles all shaders.
WAIT_S = 900

GOLD, COPPER = (1, 0.78, 0.34), (0.95, 0.64, 0.54)
RED, BLUE, CLAY, WHITE = (0.6, 0.05, 0.04), (0.1, 0.25, 0.7), (0.7, 0.5, 0.4), (0.9, 0.9, 0.9)
# Names of the inputs of each shader: colour, metalness, roughness, coat, roughness of the coat; and what else it needs.
SHADERS = {
    "standard_surface": ("base_color", "metalness", "specular_roughness", "coat", "coat_roughness", {"base": 1}),
    "open_pbr_surface": ("base_color", "base_metalness", "specular_roughness", "coat_weight", "coat_roughness", {}),
    "gltf_pbr": ("base_color", "metallic", "roughness", "clearcoat", "clearcoat_roughness", {}),
    "UsdPreviewSurface": ("diffuseColor", "metallic", "roughness", "clearcoat", "clearcoatRoughness", {}),
    "disney_principled": ("baseColor", "metallic", "roughness", "clearcoat", "clearcoatGloss", {}),
}

START = """# Imported MaterialX beside its own shaders

`scripts/furnaces-mtlx.py` makes this page. It writes {count} files of MaterialX without pictures. MaterialX {version} makes a shader of each (`EsslShaderGenerator`), and Chromium runs it in WebGL 2 under light of radiance 1 from everywhere,
with {samples:,} directions of the environment for each lobe (filtered importance sampling). `luthier import` makes a material file of each, and `luthier eval --model layered-mc` simulates its stack with {paths:,} paths. The two ways share no code.

The generated shaders are what viewers of MaterialX show, not what its formats define. They know nothing of light that goes to and fro: each lobe is brightened by a fit of what rough facets lose, and each layer is dimmed by a fit of the albedo of what lies above it. So the red
of gold, an F0 of 1, returns from .98 to 1.01 of the light. Four times as many directions change radiances by up to .002, and random numbers of the simulation by up to .001.

## The largest difference of a kind, of any channel
"""
# Brackets name a shader, a material, an angle and a channel, whose two numbers come there.
WHY = """
Metals and plastics mean the same in both where nothing else is said. The other kinds do not:

- **Rough plastics.** MaterialX dims the diffuse base by the albedo of the rough interface above it. Here the albedo of the base is such that a smooth surface shows the colour, and through a rough one a little more comes out: red of roughness .8 is [gltf_pbr, red plastic 0.8, 0, R], as beside [Cycles](cycles.md).
- **Edges of dielectrics.** Interfaces of Standard Surface and OpenPBR have Fresnel's equations; those of glTF and `UsdPreviewSurface` have Schlick's formula, and so have all of them here. At 60 degrees Fresnel's equations reflect .019 more for an index of 1.5, at 85 degrees .036 less.
- **Metals of Standard Surface** have Gulbrandsen's curve. With a white `specular_color`, the default, it is brighter than Schlick's formula from 30 degrees on, and an `f82_tint` only darkens: the import takes Schlick's formula, and says so. Blue of gold at 60 degrees: [standard_surface, gold 0.2, 60, B].
- **Metals of `UsdPreviewSurface`** reflect their colour at the edge, too. The import has an `f82_tint` that meets the colour at 82 degrees, and a white edge at the horizon: blue of copper at 75 degrees is [UsdPreviewSurface, copper 0.5, 75, B].
- **Tinted interfaces.** Standard Surface tints all that the interface reflects, and dims the base as if it were white. Here the tint is one of the F0, and the edge is white: blue at 75 degrees is [standard_surface, blue plastic 0.3, 75, B].
- **Disney's plastics.** MaterialX's shader has no Fresnel term: the interface reflects .04 at all angles, and so does the coat. Here the interface has Schlick's formula and the coat Fresnel's equations: green of red plastic under lacquer at 75 degrees is [disney_principled, red under lacquer, 75, G].
- **Rough diffuse bases.** In Standard Surface the base brightens towards its edge: red of clay is [standard_surface, clay 0.5, 0, R] at 0 degrees and [standard_surface, clay 0.5, 60, R] at 60. Here the interface bends the view, so that the base is seen less slanted. OpenPBR gives back the light that Oren and Nayar's formula loses; the import takes a slope deviation of .3 of the roughness, which loses as little. Red of clay with `base_diffuse_roughness = 1` at 0 degrees: [open_pbr_surface, clay 1, 0, R].
- **Half a metal.** `UsdPreviewSurface` in MaterialX mixes a metal with a dielectric whose F0 and diffuse part are those of half a metal already. The import blends a metal and a dielectric, as in glTF: red at 0 degrees is [UsdPreviewSurface, copper 0.4, 0, R].
- **Coats over plastics.** Here a coat bends light, so that the base is seen less slanted and its edge is not seen at all: green of red plastic under lacquer at 75 degrees is [gltf_pbr, red under lacquer, 75, G]. OpenPBR's base reflects next to nothing below its coat, and there the two agree. The coat of `UsdPreviewSurface` has Schlick's formula there, and Fresnel's equations here.
- **Coats of a colour.** Here light crosses the slab slanted, and more than twice, and is absorbed each time. MaterialX multiplies by `coat_color` once: green of white under amber at 0 degrees is [open_pbr_surface, white under amber, 0, G].
- **Coats over metals.** In MaterialX a coat dims what lies below by the albedo of the view and lets all light out again. Here it sends light back to the metal: blue of gold under lacquer at 60 degrees is [gltf_pbr, gold under lacquer, 60, B]. OpenPBR in MaterialX darkens a metal as if it were diffuse: green at 0 degrees is
  [open_pbr_surface, gold under lacquer, 0, G].

## All materials

Columns of angles have the largest difference of a channel.
"""


def material(kind, shader, name, color, metallic, roughness, coat=None, **more):
    """Kind of meaning, shader, name, and inputs of a material; `coat` is the roughness of one that covers all."""
    keys = SHADERS[shader]
    inputs = {keys[0]: color, keys[1]: metallic, keys[2]: roughness, **keys[5], **more}
    if coat is not None:
        inputs |= {keys[3]: 1, keys[4]: 1 - coat if shader == "disney_principled" else coat}
    elif shader == "disney_principled":
        inputs[keys[3]] = 0
    return kind, shader, name, inputs


def materials():
    """All materials, each with the kind of its meaning in both programs."""
    standard, pbr, gltf, usd, disney = SHADERS
    out = [material("metal with Gulbrandsen's edge", standard, f"gold {r}", GOLD, 1, r) for r in (0.2, 0.5, 0.8)]
    out += [material("metal", pbr, f"gold {r}", GOLD, 1, r) for r in (0.2, 0.5, 0.8)]
    out += [material("metal", shader, "copper 0.5", COPPER, 1, 0.5) for shader in (gltf, disney)]
    out.append(material("metal with an edge of its colour", usd, "copper 0.5", COPPER, 1, 0.5))
    out += [material("plastic", standard, f"red plastic {r}", RED, 0, r) for r in (0.2, 0.5, 0.8)]
    out += [material("plastic", shader, f"red plastic {r}", RED, 0, r) for shader in (pbr, gltf, usd) for r in (0.2, 0.8)]
    out.append(material("plastic of index 1.8", pbr, "blue plastic 0.3", BLUE, 0, 0.3, specular_ior=1.8))
    out.append(material("plastic with a tinted interface", standard, "blue plastic 0.3", BLUE, 0, 0.3, specular_color=(1, 0.5, 0.2)))
    out.append(material("Disney's plastic", disney, "red plastic 0.5", RED, 0, 0.5))
    out.append(material("rough diffuse base", standard, "clay 0.5", CLAY, 0, 0.5, diffuse_roughness=0.5))
    out += [material("rough diffuse base of OpenPBR", pbr, f"clay {r}", CLAY, 0, 0.5, base_diffuse_roughness=r) for r in (0.5, 1)]
    out += [material(kind, shader, "copper 0.4", COPPER, 0.5, 0.4) for kind, shader in (("half a metal", gltf), ("half a metal of UsdPreviewSurface", usd))]
    out += [material("coat over plastic", shader, "red under lacquer", RED, 0, 0.5, coat=0.2) for shader in (standard, gltf, usd)]
    out.append(material("coat over plastic, darkening", pbr, "red under lacquer", RED, 0, 0.5, coat=0.2))
    out.append(material("coat of a colour", pbr, "white under amber", WHITE, 0, 0.5, coat=0.1, coat_color=(1, 0.5, 0.2)))
    out += [material(kind, shader, "gold under lacquer", GOLD, 1, 0.5, coat=0.2) for kind, shader in (("coat over Gulbrandsen's metal", standard), ("coat over metal", gltf))]
    out.append(material("coat over metal, darkening", pbr, "gold under lacquer", GOLD, 1, 0.5, coat=0.2))
    out.append(material("Disney's coat", disney, "red under lacquer", RED, 0, 0.5, coat=0.2))
    return out


def document(shader, inputs):
    """A file of MaterialX with one material."""

    def line(key, value):
        kind = "color3" if isinstance(value, tuple) else "float"
        return f'    <input name="{key}" type="{kind}" value="{", ".join(map(str, value)) if kind == "color3" else value}" />\n'

    return f"""<?xml version="1.0"?>
<materialx version="1.39" colorspace="lin_rec709">
  <{shader} name="shader" type="surfaceshader">
{"".join(line(key, value) for key, value in inputs.items())}  </{shader}>
  <surfacematerial name="furnace" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="shader" />
  </surfacematerial>
</materialx>
"""


def generated(texts):
    """Version of MaterialX, and of each file the fragment shader with the values of its uniforms."""
    import MaterialX
    import MaterialX.PyMaterialXGenGlsl as glsl
    import MaterialX.PyMaterialXGenShader as gen

    libraries, search = MaterialX.createDocument(), MaterialX.getDefaultDataSearchPath()
    MaterialX.loadLibraries(MaterialX.getDefaultDataLibraryFolders(), search, libraries)
    out = []
    for text in texts:
        read = MaterialX.createDocument()
        MaterialX.readFromXmlString(read, text)
        read.setDataLibrary(libraries)
        generator = glsl.EsslShaderGenerator.create()
        context = gen.GenContext(generator)
        context.registerSourceCodeSearchPath(search)
        options = context.getOptions()
        options.hwSpecularEnvironmentMethod = gen.HwSpecularEnvironmentMethod.SPECULAR_ENVIRONMENT_FIS
        options.hwMaxActiveLightSources, options.hwSrgbEncodeOutput = 0, False
        shader = generator.generate("furnace", read.getMaterialNodes()[0], context)
        stage = shader.getStage("pixel")
        ports = [port for port in stage.getUniformBlock("PublicUniforms") if port.getValue()]
        out.append({"fragment": shader.getSourceCode("pixel"), "values": {port.getVariable(): port.getValue().getValueString() for port in ports}})
    return MaterialX.getVersionString(), out


# Draws a triangle with each shader for each angle, to a target of one pixel in floats, and sends the radiances back.
PAGE = """<!doctype html><script type="module">
const { shaders, angles, samples } = await (await fetch("/shaders.json")).json();
const answer = async (body) => fetch("/", { method: "POST", body: JSON.stringify(body) });
try {
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2");
  if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("no targets of floats");
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, 1, 1);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([255, 255, 255, 255]));
  const compiled = (program, kind, source) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  };
  const found = [];
  for (const { vertex, fragment, values } of shaders) {
    const program = gl.createProgram();
    compiled(program, gl.VERTEX_SHADER, vertex);
    compiled(program, gl.FRAGMENT_SHADER, fragment);
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    const set = (name, value) => {
      const at = gl.getUniformLocation(program, name);
      const type = at && gl.getActiveUniform(program, gl.getUniformIndices(program, [name])[0]).type;
      if (!at || type === gl.SAMPLER_2D) return;
      const numbers = value.split(",").map((part) => (part.trim() === "true" ? 1 : part.trim() === "false" ? 0 : Number(part)));
      if (numbers.some(Number.isNaN)) throw new Error(`${name}: ${value}`);
      if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, numbers);
      else if (type === gl.INT || type === gl.BOOL) gl.uniform1i(at, numbers[0]);
      else gl[`uniform${numbers.length}fv`](at, numbers);
    };
    for (const [name, value] of Object.entries(values)) set(name, value);
    set("u_envMatrix", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1");
    set("u_envLightIntensity", "1");
    set("u_envRadianceMips", "1");
    set("u_envRadianceSamples", `${samples}`);
    found.push(angles.map((angle) => {
      const turn = (angle * Math.PI) / 180;
      set("u_viewPosition", `${Math.sin(turn)},0,${Math.cos(turn)}`);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const pixel = new Float32Array(4);
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.FLOAT, pixel);
      return [...pixel.slice(0, 3)];
    }));
  }
  await answer({ found });
} catch (error) {
  await answer({ error: String(error) });
}
</script>"""

# What a vertex hands on: a plane at the origin that looks along z.
PLACE = {"normalWorld": "vec3(0, 0, 1)", "tangentWorld": "vec3(1, 0, 0)", "bitangentWorld": "vec3(0, 1, 0)", "positionWorld": "vec3(0)"}


def vertex(fragment):
    """A vertex shader of one triangle over the target, with the outputs that a fragment shader reads."""
    read = re.findall(r"^in (\w+) (\w+);", fragment, re.M)
    declared = "".join(f"out {kind} {name};\n" for kind, name in read)
    given = "".join(f"  {name} = {PLACE[name]};\n" for _, name in read)
    corner = "vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0, 1)"
    return f"#version 300 es\nprecision highp float;\n{declared}void main() {{\n{given}  gl_Position = {corner};\n}}\n"


def drawn(shaders):
    """Radiance of each shader from each angle, by a browser without a window."""
    work = json.dumps({"shaders": [{**shader, "vertex": vertex(shader["fragment"])} for shader in shaders], "angles": ANGLES, "samples": SAMPLES})
    came, answer = threading.Event(), {}

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            body, kind = (work, "application/json") if self.path == "/shaders.json" else (PAGE, "text/html")
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.end_headers()
            self.wfile.write(body.encode())

        def do_POST(self):
            answer.update(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()
            came.set()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        flags = ["--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run", f"--user-data-dir={profile}"]
        # The sandbox of Chromium does not start as root.
        flags += ["--no-sandbox"] if os.geteuid() == 0 else []
        command = [os.environ.get("CHROMIUM", "chromium"), *flags, f"http://127.0.0.1:{server.server_port}/"]
        browser = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        came.wait(WAIT_S)
        browser.terminate()
        browser.wait()
    server.shutdown()
    if "found" not in answer:
        sys.exit(f"no radiances from the browser: {answer.get('error', 'no answer')}")
    return answer["found"]


def imported(luthier, text, folder):
    """Path of the material file that the import makes of a file's only material."""
    source, target = os.path.join(folder, "furnace.mtlx"), os.path.join(folder, "materials")
    os.makedirs(folder)
    with open(source, "w") as file:
        file.write(text)
    subprocess.run([luthier, "import", source, "-o", target], check=True, capture_output=True)
    with open(os.path.join(target, "import.json")) as file:
        (found,) = json.load(file)["sources"][0]["materials"]
    return os.path.join(target, found["file"])


def simulated(luthier, path):
    """Albedo of a material file at each angle."""
    angles = ",".join(str(angle) for angle in ANGLES)
    command = [luthier, "eval", path, "--model", "layered-mc", "--albedo", "--rgb", "--angles", angles, "--samples", str(PATHS), "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return [row["albedo"] for row in found["albedo"]]


def text(rgb):
    return " ".join(f"{c:.3f}" for c in rgb)


def report(version, given, ours, theirs):
    """The page, and materials of one meaning that are apart."""
    rows = []
    for (kind, shader, name, _), own, other in zip(given, ours, theirs):
        apart = [max(abs(a - b) for a, b in zip(x, y)) for x, y in zip(own, other)]
        rows.append((kind, shader, name, apart, own, other))

    def both(shader, name, angle, channel):
        """Number of luthier and that of MaterialX."""
        own, other = next(row[4:] for row in rows if row[1:3] == (shader, name))
        return "{:.3f} here, {:.3f} there".format(*(values[ANGLES.index(angle)]["RGB".index(channel)] for values in (own, other)))

    page = [START.format(count=len(rows), version=version, samples=SAMPLES, paths=PATHS)]
    page.append(f"| kind | materials | {' | '.join(f'{angle} degrees' for angle in ANGLES)} |\n|---|--:|{'--:|' * len(ANGLES)}")
    for kind in dict.fromkeys(row[0] for row in rows):
        of_kind = [row[3] for row in rows if row[0] == kind]
        page.append(f"| {kind} | {len(of_kind)} | {' | '.join(f'{max(column):.3f}' for column in zip(*of_kind))} |")
    page.append(re.sub(r"\[(\w+), ([^,]+), (\d+), ([RGB])\]", lambda m: both(m[1], m[2], int(m[3]), m[4]), WHY))
    page.append(f"| shader | material | kind | {' | '.join(f'{angle}' for angle in ANGLES)} | luthier, 0 degrees | MaterialX | luthier, 60 degrees | MaterialX |\n|---|---|---|{'--:|' * len(ANGLES)}---|---|---|---|")
    for kind, shader, name, apart, own, other in rows:
        at = ANGLES.index(60)
        shares = " | ".join(f"{share:.3f}" for share in apart)
        page.append(f"| `{shader}` | {name} | {kind} | {shares} | {text(own[0])} | {text(other[0])} | {text(own[at])} | {text(other[at])} |")
    far = [f"{shader}, {name}: {max(apart[:3]):.3f}" for kind, shader, name, apart, _, _ in rows if kind in SAME and max(apart[:3]) > APART]
    return "\n".join(page) + "\n", far


def main(luthier, output):
    given = materials()
    texts = [document(shader, inputs) for _, shader, _, inputs in given]
    with tempfile.TemporaryDirectory() as folder:
        ours = [simulated(luthier, imported(luthier, text, os.path.join(folder, str(i)))) for i, text in enumerate(texts)]
    version, shaders = generated(texts)
    page, far = report(version, given, ours, drawn(shaders))
    with open(output, "w") as file:
        file.write(page)
    if far:
        sys.exit(f"materials that mean the same are more than {APART} apart up to 60 degrees: " + "; ".join(far))


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]), sys.argv[2])
