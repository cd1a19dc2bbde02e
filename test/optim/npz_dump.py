#!/usr/bin/python3
"""Writes the arrays of numpy .npz files for test/optim/mpc_qp_set.hpp: per array a line `file array rows columns`, then its numbers as little-endian doubles, row by row."""
import pathlib
import sys

import numpy as np

for file in map(pathlib.Path, sys.argv[1:]):
    with np.load(file, allow_pickle=False) as arrays:
        for name in arrays.files:
            data = np.asarray(arrays[name], dtype="<f8")
            data = np.ascontiguousarray(data if data.ndim == 2 else data.reshape(-1, 1))
            sys.stdout.buffer.write(f"{file.stem} {name} {data.shape[0]} {data.shape[1]}\n".encode())
            sys.stdout.buffer.write(data.tobytes())
