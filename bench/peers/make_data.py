#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Tilth authors
# SPDX-License-Identifier: BSD-3-Clause
"""Turn a table of spheres (x, y, z, radius[, v, w]) into a data file of LAMMPS or LIGGGHTS.

make_data.py TABLE[.gz] OUT --box LX LY LZ [--types N] [--density D]
"""
import argparse
import csv
import gzip


def main():
    p = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    p.add_argument('table')
    p.add_argument('out')
    p.add_argument('--box', nargs=3, type=float, required=True)
    p.add_argument('--types', type=int, default=1)
    p.add_argument('--density', default='1.0')
    a = p.parse_args()
    with (gzip.open if a.table.endswith('.gz') else open)(a.table, 'rt') as f:
        rows = list(csv.reader(line for line in f if not line.startswith('#')))[1:]
    margin = 1.0  # beyond the walls, so that no sphere is lost that overlaps one
    with open(a.out, 'w') as f:
        f.write(f'spheres of {a.table}\n\n{len(rows)} atoms\n{a.types} atom types\n\n')
        for axis, length in zip('xyz', a.box):
            f.write(f'{-margin} {length + margin} {axis}lo {axis}hi\n')
        f.write('\nAtoms\n\n')
        for i, r in enumerate(rows, 1):
            f.write(f'{i} 1 {2 * float(r[3]):.9g} {a.density} {r[0]} {r[1]} {r[2]}\n')
        if len(rows[0]) == 10:
            f.write('\nVelocities\n\n')
            for i, r in enumerate(rows, 1):
                f.write(f'{i} {" ".join(r[4:10])}\n')


if __name__ == '__main__':
    main()
