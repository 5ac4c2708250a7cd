# SPDX-FileCopyrightText: 2026 The Tilth authors
# SPDX-License-Identifier: BSD-3-Clause
# Settled or flowing bed, YADE. Constants: tests/reference/settled_bed/README.md
#   yade -n -x -j1 yade_settled_bed.py        settings by environment: CASE (settled | flow), WARM_UP, STEPS
# This law takes one viscous coefficient for a pair of materials: it is m_eff * 40 for spheres of radius 1.
import csv, gzip, math, os, sys, time
from yade.utils import *

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
ROOT = os.path.join(HERE, '..', '..')
FLOW = os.environ.get('CASE', 'settled') == 'flow'
FILE = os.path.join(ROOT, 'bench/reference/flow_32k.csv.gz' if FLOW else 'tests/reference/settled_bed/settled_4k.csv')
BOX = (62.413753, 62.413753, 124.827505) if FLOW else (32.293201, 32.293201, 64.586402)
WARM_UP = int(os.environ.get('WARM_UP', 50 if FLOW else 200))
STEPS = int(os.environ.get('STEPS', 600 if FLOW else 4000))
K_N, K_T, MU = 2e4, 1e4, 0.5
M_EFF = 4 / 3 * math.pi / 2
C_N, C_T = 40 * M_EFF, 20 * M_EFF

# The pair value is 2 a b / (a + b): a very large wall value gives a wall twice the damping of a pair (m_eff = m).
O.materials.append(ViscElMat(kn=K_N, ks=K_T, cn=C_N, cs=C_T, frictionAngle=math.atan(MU), density=1, label='grain'))
O.materials.append(ViscElMat(kn=K_N, ks=K_T, cn=1e15, cs=0, frictionAngle=0, density=1, label='wall'))
with (gzip.open if FILE.endswith('.gz') else open)(FILE, 'rt') as f:
    rows = csv.reader(line for line in f if not line.startswith('#'))
    next(rows)
    for row in rows:
        v = [float(a) for a in row]
        b = sphere(v[:3], v[3], material='grain')
        if FLOW:
            b.state.vel, b.state.angVel = v[4:7], v[7:10]
        O.bodies.append(b)
n = len(O.bodies)
for axis in range(3):
    O.bodies.append(wall(0.0, axis=axis, sense=1, material='wall'))
    O.bodies.append(wall(BOX[axis], axis=axis, sense=-1, material='wall'))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.15 if FLOW else 0.05),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
                    [Ip2_ViscElMat_ViscElMat_ViscElPhys()], [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(damping=0, gravity=(1.5, 0, -1) if FLOW else (0, 0, -1)),
]
O.dt = 5e-4
O.run(WARM_UP, True)
cpu = time.process_time()
O.run(STEPS, True)
cpu = time.process_time() - cpu
touching = sum(1 for i in O.interactions if i.isReal and i.id1 < n and i.id2 < n)
print('RESULT particles %d steps %d cpu_s %.3f million_particle_steps_per_cpu_s %.3f' % (n, STEPS, cpu, n * STEPS / cpu / 1e6))
print('CHECK coordination %.3f' % (2 * touching / n))
sys.stdout.flush()
os._exit(0)
