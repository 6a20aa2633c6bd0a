from ravemj.meshes.files import MeshFile, read_bytes, unpacked
def read_mesh(path):
    from ravemj.meshes.inventor import read_inventor
    f=MeshFile(path, unpacked(read_bytes(path),path))
    return read_inventor(f)
