"""MaterialX 1.39.5 as a host of a library: its generators, and its renderer for OpenGL, which needs an X display (xvfb-run)."""

import ctypes
import math
import pathlib
import sys

import MaterialX as mx
from MaterialX import PyMaterialXGenGlsl as glsl
from MaterialX import PyMaterialXGenMsl as msl
from MaterialX import PyMaterialXGenShader as gen
from MaterialX import PyMaterialXGenSlang as slang
from MaterialX import PyMaterialXRender as render
from MaterialX import PyMaterialXRenderGlsl as opengl

GENERATORS = {
    "GLSL": glsl.GlslShaderGenerator, "ESSL": glsl.EsslShaderGenerator, "Vulkan": glsl.VkShaderGenerator, "WGSL": glsl.WgslShaderGenerator,
    "Metal": msl.MslShaderGenerator, "Slang": slang.SlangShaderGenerator,
}
# Those of `luthier preview --shape sphere`.
EYE, HALF_HEIGHT = 7, 1.22 / 7


class Host:
    """The libraries of MaterialX with that of a bake, and the bake's materials."""

    def __init__(self, library, prefix="luthier"):
        self.library = pathlib.Path(library).resolve()
        self.path = mx.getDefaultDataSearchPath()
        self.document = mx.createDocument()
        mx.loadLibraries(mx.getDefaultDataLibraryFolders(), self.path, self.document)
        mx.loadLibraries([prefix], mx.FileSearchPath(str(self.library)), self.document)
        mx.readFromXmlFile(self.document, str(self.library / "materials.mtlx"))
        self.lights = []

    def add_light(self, towards, irradiance):
        """A directional light."""
        length = math.hypot(*towards)
        light = self.document.addNode("directional_light", f"light_{len(self.lights)}", "lightshader")
        light.setInputValue("direction", mx.Vector3(*(-x / length for x in towards)))
        light.setInputValue("color", mx.Color3(*irradiance))
        light.setInputValue("intensity", 1.0)
        self.lights.append(light)

    def generate(self, material, target="GLSL", turned=True):
        """The shader of a material, and the lights. `turned` tells that images are loaded with their first row first, as programs of MaterialX do."""
        generator = GENERATORS[target].create()
        generator.registerTypeDefs(self.document)
        colors = gen.DefaultColorManagementSystem.create(generator.getTarget())
        colors.loadLibrary(self.document)
        generator.setColorManagementSystem(colors)
        context = gen.GenContext(generator)
        context.registerSourceCodeSearchPath(self.path)
        context.getOptions().fileTextureVerticalFlip = turned
        lights = render.LightHandler.create()
        lights.setLightSources(self.lights)
        lights.registerLights(self.document, self.lights, context)
        return generator.generate(material, self.document.getNode(material), context), lights

    def text(self, material, target):
        """The fragment shader of a material."""
        return self.generate(material, target)[0].getSourceCode(gen.PIXEL_STAGE)


class Renderer:
    """Draws balls with the renderer of MaterialX."""

    def __init__(self, size, folder):
        self.size = size
        self.renderer = opengl.GlslRenderer.create(size, size, render.BaseType.FLOAT)
        self.renderer.initialize()
        mesh = pathlib.Path(folder) / "ball.obj"
        mesh.write_text(ball(256, 128))
        self.renderer.getGeometryHandler().loadGeometry(mx.FilePath(str(mesh)), False)
        camera = render.Camera.create()
        camera.setViewMatrix(render.Camera.createViewMatrix(mx.Vector3(0, 0, EYE), mx.Vector3(0, 0, 0), mx.Vector3(0, 1, 0)))
        half = HALF_HEIGHT
        camera.setProjectionMatrix(render.Camera.createPerspectiveMatrix(-half, half, -half, half, 1, 100))
        self.renderer.setCamera(camera)

    def draw(self, host, material, turned=True, environment=None):
        """Linear radiance, RGB by rows from the top; None where there is no ball. `environment` is an image of light from all around, and the draws of a pixel."""
        shader, lights = host.generate(material, turned=turned)
        images = opengl.GLTextureHandler.create(render.StbImageLoader.create())
        images.setSearchPath(mx.FileSearchPath(str(host.library)))
        lights.setIndirectLighting(environment is not None)
        if environment:
            map_ = images.acquireImage(mx.FilePath(str(environment[0])))
            lights.setEnvRadianceMap(map_)
            lights.setEnvIrradianceMap(map_)
            lights.setEnvSampleCount(environment[1])
        self.renderer.setImageHandler(images)
        self.renderer.setLightHandler(lights)
        self.renderer.createProgram(shader)
        self.renderer.validateInputs()
        self.renderer.render()
        image = self.renderer.captureImage(None)
        count = 4 * self.size * self.size
        values = (ctypes.c_float * count).from_address(image.getResourceBuffer())[:]
        rows = [values[4 * self.size * y : 4 * self.size * (y + 1)] for y in range(self.size)]
        outside = rows[0][:3]
        pixels = [[tuple(row[i : i + 3]) for i in range(0, len(row), 4)] for row in reversed(rows)]
        return [[None if list(pixel) == outside else pixel for pixel in row] for row in pixels]


def ball(columns, rows):
    """A Wavefront file of the unit ball, whose texture coordinates begin behind; v counts from the bottom."""
    lines = []
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            x, y, z = math.sin(math.pi * v) * math.sin(2 * math.pi * (u - 0.5)), -math.cos(math.pi * v), math.sin(math.pi * v) * math.cos(2 * math.pi * (u - 0.5))
            lines += [f"v {x:.9f} {y:.9f} {z:.9f}", f"vt {u:.9f} {v:.9f}", f"vn {x:.9f} {y:.9f} {z:.9f}"]
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i + 1
            b, c = a + columns + 1, a + columns + 2
            lines += [f"f {a}/{a}/{a} {a + 1}/{a + 1}/{a + 1} {c}/{c}/{c}", f"f {a}/{a}/{a} {c}/{c}/{c} {b}/{b}/{b}"]
    return "\n".join(lines) + "\n"
