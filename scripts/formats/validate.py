"""Asks MaterialX about .mtlx files. Fails where a document is not valid, where the libraries know no node of it, or where no shader can be generated from a material.

    python validate.py FILE...
"""

import sys

import MaterialX as mx
import MaterialX.PyMaterialXGenGlsl as gen_glsl
import MaterialX.PyMaterialXGenShader as gen


def problems(path: str) -> list[str]:
    library = mx.createDocument()
    search = mx.getDefaultDataSearchPath()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), search, library)
    document = mx.createDocument()
    mx.readFromXmlFile(document, path)
    document.setDataLibrary(library)
    found = []
    valid, message = document.validate()
    if not valid:
        found.append(message)
    for node in document.getNodes() + [node for graph in document.getNodeGraphs() for node in graph.getNodes()]:
        definition = node.getNodeDef()
        if definition is None:
            found.append(f"no definition of {node.getName()}")
            continue
        for given in node.getInputs():
            known = definition.getActiveInput(given.getName())
            if known is None or known.getType() != given.getType():
                found.append(f"{node.getName()} has no input {given.getName()} of type {given.getType()}")
    generator = gen_glsl.GlslShaderGenerator.create()
    context = gen.GenContext(generator)
    context.registerSourceCodeSearchPath(search)
    shaders = document.getMaterialNodes()
    for material in shaders:
        if not generator.generate(material.getName(), material, context):
            found.append(f"no shader of {material.getName()}")
    print(f"{path}: {len(shaders)} materials, {len(found)} faults")
    return found


failed = False
for path in sys.argv[1:]:
    for problem in problems(path):
        failed = True
        print(f"{path}: {problem}", file=sys.stderr)
sys.exit(1 if failed or len(sys.argv) < 2 else 0)
