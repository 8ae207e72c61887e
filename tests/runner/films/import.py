"""Where Blender's importer has the vertices of a glTF file, at each key of its animation:

blender -b --python-exit-code 1 -P import.py -- FILE OUT

Writes x, y, z of every vertex, moment after moment, as doubles, in the file's axes (y up)."""
import struct
import sys

import bpy
import numpy

numpy.bool = bool  # the importer of Blender 3.4 asks for a name that numpy has dropped
path, out = sys.argv[-2:]
with open(path, 'rb') as file:
    import json
    data = file.read()
length = struct.unpack('<I', data[12:16])[0]
glb = json.loads(data[20:20 + length])
accessor = glb['accessors'][glb['animations'][0]['samplers'][0]['input']]
view = glb['bufferViews'][accessor['bufferView']]
at = 28 + length + view['byteOffset']
times = struct.unpack(f"<{accessor['count']}f", data[at:at + 4 * accessor['count']])

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.render.fps = 1000
bpy.ops.import_scene.gltf(filepath=path)
mesh = next(o for o in bpy.data.objects if o.type == 'MESH' and o.find_armature())
with open(out, 'wb') as file:
    for time in times:
        frame = 1000 * time
        scene.frame_set(int(frame), subframe=frame - int(frame))
        moved = mesh.evaluated_get(bpy.context.evaluated_depsgraph_get())
        for vertex in moved.data.vertices:
            x, y, z = moved.matrix_world @ vertex.co
            file.write(struct.pack('<3d', x, z, -y))
