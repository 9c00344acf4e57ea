"""Blender's Vector Blur node over the public sequence: an independent figure beside bench_blur_quality's. Optional; nothing
in the project needs it or runs it.

  blender --background --factory-startup --python-exit-code 1 --python tests/bench/blender_vector_blur.py -- DATA OUT [FACTOR]

DATA is the folder that holds yard/; OUT receives yard_vb.####.exr, R G B A, float. FACTOR is the node's "Blur". Frames given in
the environment variable FRAMES ("3,6,9") are all that is done.
"""
import os
import shutil
import sys

import bpy

SAMPLES = 64


def multilayer_image(tree, path):
    image = bpy.data.images.load(path)
    node = tree.nodes.new("CompositorNodeImage")
    node.image = image
    return node


def blur(source, target, factor):
    scene = bpy.context.scene
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    image = multilayer_image(tree, source)
    scene.render.resolution_x, scene.render.resolution_y = image.image.size
    scene.render.resolution_percentage = 100

    node = tree.nodes.new("CompositorNodeVecBlur")
    node.samples, node.factor, node.use_curved = SAMPLES, factor, False
    for name, output in (("Image", "Combined"), ("Z", "Depth"), ("Speed", "Vector")):
        tree.links.new(image.outputs[output], node.inputs[name])

    folder = os.path.dirname(target)
    file = tree.nodes.new("CompositorNodeOutputFile")
    file.base_path, file.file_slots[0].path = folder, "working_"
    file.format.file_format, file.format.color_depth = "OPEN_EXR", "32"
    tree.links.new(node.outputs["Image"], file.inputs[0])
    composite = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(node.outputs["Image"], composite.inputs["Image"])

    bpy.ops.render.render()
    shutil.move(os.path.join(folder, "working_%04d.exr" % scene.frame_current), target)
    bpy.data.images.remove(image.image)


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    data, out = arguments[0], os.path.abspath(arguments[1])
    factor = float(arguments[2]) if len(arguments) > 2 else 1.0
    frames = [int(f) for f in os.environ.get("FRAMES", "").split(",") if f] or range(1, 13)
    os.makedirs(out, exist_ok=True)
    for frame in frames:
        source = os.path.join(data, "yard", "yard.%04d.exr" % frame)
        blur(os.path.abspath(source), os.path.join(out, "yard_vb.%04d.exr" % frame), factor)


main()
