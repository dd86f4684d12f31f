"""Writes the files of this folder, with writers that share nothing with this project.

    python3 -m venv /tmp/writers && /tmp/writers/bin/pip install numpy trimesh pygltflib plyfile numpy-stl pillow
    /tmp/writers/bin/python formats/tests/formats/files/make.py

The tests read what is committed. Every file shows the same mesh, in the same order: a pyramid of six triangles. What each
writer was asked for stands beside it. The Khronos validator (`npm install gltf-validator`) finds neither errors nor warnings
in the glTF files.
"""

import base64
import io
from pathlib import Path

import numpy as np
import plyfile
import pygltflib
from PIL import Image
import stl.mesh
import trimesh

HERE = Path(__file__).parent

POSITIONS = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0.1, 1.7, 0.3]], np.float32)
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3], [1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]], np.uint32)
NORMALS = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 1, 0]], np.float32)


def with_trimesh():
    mesh = trimesh.Trimesh(POSITIONS, TRIANGLES, process=False)
    for name in ["trimesh.obj", "trimesh.ply", "trimesh.stl", "trimesh.glb"]:
        mesh.export(HERE / name)
    mesh.export(HERE / "trimesh-ascii.stl", file_type="stl_ascii")
    mesh.export(HERE / "trimesh-ascii.ply", encoding="ascii")
    # A scene: two nodes share the mesh, and one moves it.
    scene = trimesh.Scene()
    scene.add_geometry(mesh, node_name="here", geom_name="pyramid")
    scene.graph.update("there", geometry="pyramid", matrix=trimesh.transformations.compose_matrix(
        scale=[2, 1, 0.5], angles=[0.3, -0.2, 1.1], translate=[5, 0, -2]))
    scene.export(HERE / "trimesh-scene.glb")


def with_plyfile():
    vertices = np.empty(5, [(n, "f4") for n in ["x", "y", "z", "nx", "ny", "nz"]] + [(n, "u1") for n in ["red", "green", "blue"]])
    for k, name in enumerate("xyz"):
        vertices[name], vertices["n" + name] = POSITIONS[:, k], NORMALS[:, k]
    vertices["red"], vertices["green"], vertices["blue"] = 200, 100, 50
    faces = np.empty(6, [("vertex_indices", "i4", (3,))])
    faces["vertex_indices"] = TRIANGLES
    elements = [plyfile.PlyElement.describe(vertices, "vertex"), plyfile.PlyElement.describe(faces, "face")]
    for order, name in [("<", "little"), (">", "big")]:
        plyfile.PlyData(elements, byte_order=order).write(HERE / f"plyfile-{name}.ply")
    plyfile.PlyData(elements, text=True).write(HERE / "plyfile-ascii.ply")


def with_numpy_stl():
    # Its binary files begin with the name of the solid: here with "solid".
    data = np.zeros(6, stl.mesh.Mesh.dtype)
    data["vectors"] = POSITIONS[TRIANGLES]
    mesh = stl.mesh.Mesh(data)
    mesh.name = b"solid pyramid"
    mesh.save(str(HERE / "numpy-stl.stl"), mode=stl.Mode.BINARY, update_normals=True)
    mesh.save(str(HERE / "numpy-stl-ascii.stl"), mode=stl.Mode.ASCII, update_normals=True)
    binary = HERE / "numpy-stl.stl"
    content = bytearray(binary.read_bytes())
    # Without the time of day.
    content[:80] = b"solid pyramid".ljust(80)
    binary.write_bytes(content)


def with_pygltflib():
    g = pygltflib
    blob, views, accessors = b"", [], []

    def add(array, kind, component, target, normalized=False, stride=None):
        nonlocal blob
        data = array.tobytes()
        views.append(g.BufferView(buffer=0, byteOffset=len(blob), byteLength=len(data), byteStride=stride, target=target))
        blob += data + b"\0" * (-len(data) % 4)
        count = len(array)
        limits = {}
        if kind == g.VEC3 and component == g.FLOAT:
            limits = {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        accessors.append(g.Accessor(bufferView=len(views) - 1, componentType=component, count=count, type=kind,
                                    normalized=normalized, **limits))
        return len(accessors) - 1

    position = add(POSITIONS, g.VEC3, g.FLOAT, g.ARRAY_BUFFER)
    normal = add(NORMALS / np.linalg.norm(NORMALS, axis=1)[:, None].astype(np.float32), g.VEC3, g.FLOAT, g.ARRAY_BUFFER)
    texture = np.array([[0, 0], [255, 0], [255, 255], [0, 255], [128, 51]], np.uint8)
    padded = np.zeros((5, 4), np.uint8)
    padded[:, :2] = texture
    coordinate = add(padded, g.VEC2, g.UNSIGNED_BYTE, g.ARRAY_BUFFER, normalized=True, stride=4)
    indices = add(TRIANGLES.astype(np.uint16).ravel(), g.SCALAR, g.UNSIGNED_SHORT, g.ELEMENT_ARRAY_BUFFER)
    attributes = g.Attributes(POSITION=position, NORMAL=normal, TEXCOORD_0=coordinate)
    half = np.sin(np.pi / 8)
    model = g.GLTF2(
        scene=0, scenes=[g.Scene(nodes=[0, 2])],
        nodes=[
            g.Node(name="group", translation=[1, 2, 3], children=[1]),
            g.Node(name="pyramid", mesh=0, rotation=[0, 1, 0, 0], scale=[1, -1, 1]),
            g.Node(name="tripod", camera=0, translation=[0, 1, 9], rotation=[-half, 0, 0, float(np.sqrt(1 - half * half))]),
            g.Node(name="unused", mesh=0),
        ],
        cameras=[g.Camera(name="front", type="perspective", perspective=g.Perspective(aspectRatio=1.5, yfov=0.8, znear=0.1))],
        meshes=[g.Mesh(name="pyramid", primitives=[g.Primitive(attributes=attributes, indices=indices, material=0)])],
        materials=[g.Material(name="copper", pbrMetallicRoughness=g.PbrMetallicRoughness(baseColorFactor=[0.6, 0.25, 0.1, 1]))],
        accessors=accessors, bufferViews=views, buffers=[g.Buffer(byteLength=len(blob))])
    model.set_binary_blob(blob)
    model.save_binary(str(HERE / "pygltflib.glb"))
    model.convert_buffers(g.BufferFormat.DATAURI)
    model.save_json(str(HERE / "pygltflib-data.gltf"))
    model.buffers[0].uri = "pygltflib%20data.bin"
    (HERE / "pygltflib data.bin").write_bytes(blob)
    model.save_json(str(HERE / "pygltflib-beside.gltf"))


# A picture without symmetry: red and green above, blue and grey below; and a square that shows it twice as large.
PICTURE = Image.fromarray(np.array([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [188, 188, 188]]], np.uint8))
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.uint16)
COLORS = np.array([[255, 255, 255, 255], [51, 255, 255, 255], [255, 102, 255, 255], [255, 255, 0, 255]], np.uint8)


def textured_with_trimesh():
    # trimesh counts v from the lower edge, and turns it around where glTF wants that.
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    mesh = trimesh.Trimesh(SQUARE, HALVES, visual=trimesh.visual.TextureVisuals(uv=uv, image=PICTURE), process=False)
    mesh.visual.material.name = "four"
    mesh.export(HERE / "trimesh-texture.glb")
    mesh.export(HERE / "trimesh-texture.obj", mtl_name="trimesh-texture.mtl")
    print("colours of the corners, as trimesh reads them:", mesh.visual.to_color().vertex_colors.tolist())


def textured_with_pygltflib():
    g = pygltflib
    png = io.BytesIO()
    PICTURE.save(png, "PNG")
    (HERE / "pygltflib texture.png").write_bytes(png.getvalue())
    # From −1 to 2, counted from the upper edge. The material names this second set; the first one is all zeros.
    uv = np.array([[-1, 2], [2, 2], [2, -1], [-1, -1]], np.float32)
    parts = [(SQUARE, g.ARRAY_BUFFER), (uv, g.ARRAY_BUFFER), (COLORS, g.ARRAY_BUFFER), (HALVES.ravel(), g.ELEMENT_ARRAY_BUFFER),
             (np.frombuffer(png.getvalue(), np.uint8), None), (np.zeros_like(uv), g.ARRAY_BUFFER)]
    blob, views = b"", []
    for part, target in parts:
        views.append(g.BufferView(buffer=0, byteOffset=len(blob), byteLength=part.nbytes, target=target))
        blob += part.tobytes() + b"\0" * (-part.nbytes % 4)
    accessors = [
        g.Accessor(bufferView=0, componentType=g.FLOAT, count=4, type=g.VEC3, min=[0, 0, 0], max=[1, 1, 0]),
        g.Accessor(bufferView=1, componentType=g.FLOAT, count=4, type=g.VEC2),
        g.Accessor(bufferView=2, componentType=g.UNSIGNED_BYTE, count=4, type=g.VEC4, normalized=True),
        g.Accessor(bufferView=3, componentType=g.UNSIGNED_SHORT, count=6, type=g.SCALAR),
        g.Accessor(bufferView=5, componentType=g.FLOAT, count=4, type=g.VEC2),
    ]
    color = g.PbrMetallicRoughness(baseColorFactor=[1, 0.5, 0.25, 1], baseColorTexture=g.TextureInfo(index=0, texCoord=1))
    attributes = g.Attributes(POSITION=0, TEXCOORD_0=4, TEXCOORD_1=1, COLOR_0=2)
    model = g.GLTF2(
        scene=0, scenes=[g.Scene(nodes=[0])], nodes=[g.Node(mesh=0)],
        meshes=[g.Mesh(primitives=[g.Primitive(attributes=attributes, indices=3, material=0)])],
        materials=[g.Material(name="four", pbrMetallicRoughness=color)],
        textures=[g.Texture(source=0, sampler=0)],
        samplers=[g.Sampler(magFilter=g.NEAREST, minFilter=g.LINEAR_MIPMAP_NEAREST, wrapS=g.MIRRORED_REPEAT, wrapT=g.CLAMP_TO_EDGE)],
        images=[g.Image(bufferView=4, mimeType="image/png")],
        accessors=accessors, bufferViews=views, buffers=[g.Buffer(byteLength=len(blob))])
    model.set_binary_blob(blob)
    model.save_binary(str(HERE / "pygltflib-texture.glb"))
    model.convert_buffers(g.BufferFormat.DATAURI)
    model.images = [g.Image(uri="pygltflib%20texture.png")]
    model.save_json(str(HERE / "pygltflib-texture-beside.gltf"))
    model.images = [g.Image(uri="data:image/png;base64," + base64.b64encode(png.getvalue()).decode())]
    model.save_json(str(HERE / "pygltflib-texture-data.gltf"))


if __name__ == "__main__":
    textured_with_trimesh()
    textured_with_pygltflib()
    with_trimesh()
    with_plyfile()
    with_numpy_stl()
    with_pygltflib()
