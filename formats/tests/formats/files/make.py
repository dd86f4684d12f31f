"""Writes the files of this folder, with writers that share nothing with this project.

    python3 -m venv /tmp/writers && /tmp/writers/bin/pip install numpy trimesh pygltflib plyfile numpy-stl
    /tmp/writers/bin/python formats/tests/formats/files/make.py

The tests read what is committed. Every file shows the same mesh, in the same order: a pyramid of six triangles. What each
writer was asked for stands beside it.
"""

from pathlib import Path

import numpy as np
import plyfile
import pygltflib
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


if __name__ == "__main__":
    with_trimesh()
    with_plyfile()
    with_numpy_stl()
    with_pygltflib()
