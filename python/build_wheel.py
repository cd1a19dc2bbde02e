"""Builds the wheel with CMake: the C++ library, the tool and the shipped loops go into the package, which is a prefix of its own."""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

TOP = pathlib.Path(__file__).resolve().parent.parent


def _project():
    """Name, version and the like of pyproject.toml; Python 3.9 has no reader of TOML."""
    text = (TOP / "pyproject.toml").read_text(encoding="utf-8").split("[project]")[1]
    return dict(re.findall(r'^(name|version|description|requires-python) = "(.*)"$', text.split("\n[")[0], flags=re.M))


def _tag():
    abi = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{abi}-{abi}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _metadata():
    p = _project()
    lines = ["Metadata-Version: 2.1", f"Name: {p['name']}", f"Version: {p['version']}", f"Summary: {p['description']}",
             "License: BSD-3-Clause", f"Requires-Python: {p['requires-python']}", "Requires-Dist: numpy", "Provides-Extra: plots",
             "Requires-Dist: matplotlib; extra == 'plots'", "Provides-Extra: frames", "Requires-Dist: pandas; extra == 'frames'"]
    return "\n".join(lines) + "\n"


def _info(tag):
    """Files of the folder .dist-info but RECORD."""
    return {"METADATA": _metadata(), "WHEEL": f"Wheel-Version: 1.0\nGenerator: fmbpc\nRoot-Is-Purelib: false\nTag: {tag}\n",
            "entry_points.txt": "[console_scripts]\nfmbpc = fmbpc.__main__:main\n"}


def _cmake_install(prefix, build):
    """Into a folder that is package and prefix at once."""
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if any(os.access(os.path.join(d, "ccache"), os.X_OK) for d in os.get_exec_path()) else []
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL") or str(os.cpu_count() or 1)
    subprocess.run(["cmake", "-S", str(TOP), "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DFMBPC_WITH_ROS=OFF", "-DFMBPC_BENCH=OFF", "-DFMBPC_TESTS=OFF",
                    "-DFMBPC_WITH_MPI=OFF", "-DFMBPC_PYTHON=.", f"-DFMBPC_CORE_OBJECTS={os.environ.get('FMBPC_WHEEL_CORE', '')}",
                    f"-DPython3_EXECUTABLE={sys.executable}", *launcher], check=True)
    subprocess.run(["cmake", "--build", build, "-j", jobs], check=True)
    subprocess.run(["cmake", "--install", build, "--prefix", str(prefix), "--strip"], check=True)


def _digest(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    p, tag = _project(), _tag()
    info = f"{p['name']}-{p['version']}.dist-info"
    name = f"{p['name']}-{p['version']}-{tag}.whl"
    with tempfile.TemporaryDirectory() as work:
        package = pathlib.Path(work) / p["name"]
        _cmake_install(package, os.environ.get("FMBPC_WHEEL_BUILD") or os.path.join(work, "build"))
        files = {f"{p['name']}/{f.relative_to(package).as_posix()}": f for f in sorted(package.rglob("*")) if f.is_file() and not f.is_symlink()}
        for link in (f for f in package.rglob("*") if f.is_symlink()):  # a wheel has none: the library under the name that is looked for
            if re.search(r"\.so\.\d+\.\d+$", link.name):
                files[f"{p['name']}/{link.relative_to(package).as_posix()}"] = link.resolve()
        texts = {f"{info}/{file}": text for file, text in _info(tag).items()}
        record = []
        with zipfile.ZipFile(os.path.join(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
            for where, data, mode in [(w, f.read_bytes(), f.stat().st_mode) for w, f in files.items()] + [(w, t.encode(), 0o100644) for w, t in texts.items()]:
                entry = zipfile.ZipInfo(where, (2020, 1, 1, 0, 0, 0))
                entry.external_attr = mode << 16
                entry.compress_type = zipfile.ZIP_DEFLATED
                wheel.writestr(entry, data)
                record.append(f"{where},{_digest(data)},{len(data)}")
            wheel.writestr(f"{info}/RECORD", "\n".join(record + [f"{info}/RECORD,,"]) + "\n")
    return name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without this pip builds a wheel to read its name, and then another one."""
    p = _project()
    folder = pathlib.Path(metadata_directory) / f"{p['name']}-{p['version']}.dist-info"
    folder.mkdir()
    for file, text in _info(_tag()).items():
        (folder / file).write_text(text, encoding="utf-8")
    return folder.name


def get_requires_for_build_wheel(config_settings=None):
    return []
