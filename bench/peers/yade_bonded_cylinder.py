# SPDX-FileCopyrightText: 2026 The Tilth authors
# SPDX-License-Identifier: BSD-3-Clause
# Bonded cylinder in unconfined compression, YADE. Constants: tests/reference/bonded_cylinder/README.md
#   yade -n -x -j1 yade_bonded_cylinder.py        settings by environment: STEPS (12000), OUT (curve, csv)
import csv, math, os, sys, time
from yade.utils import *

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
CASE = os.path.join(HERE, '..', '..', 'tests', 'reference', 'bonded_cylinder')
STEPS = int(os.environ.get('STEPS', 12000))
OUT = os.environ.get('OUT')
H, R_CYLINDER = 37.252929, 10.243342
DT, RATE = 5e-4, 3e-3
K_N, K_S, K_BEND, K_TWIST = 1e5, 4e4, 2.5e4, 2e4
TENSION, SHEAR, MU = 1000.0, 500.0, 0.5


def table(name):
    with open(os.path.join(CASE, name)) as f:
        rows = csv.reader(line for line in f if not line.startswith('#'))
        next(rows)
        return list(rows)


# In these laws young * 2 r1 r2 / (r1 + r2) is the normal stiffness of a new contact (young * r at a plate) and poisson the
# ratio shear / normal.
grain = O.materials.append(CohFrictMat(young=K_N, poisson=K_S / K_N, density=1, frictionAngle=math.atan(MU),
                                       momentRotationLaw=True, normalCohesion=0, shearCohesion=0, label='grain'))
plate = O.materials.append(FrictMat(young=K_N, poisson=K_S / K_N, density=1, frictionAngle=0, label='plate'))
for x, y, z, r in table('spheres.csv'):
    O.bodies.append(sphere((float(x), float(y), float(z)), float(r), material='grain'))
bottom = O.bodies.append(wall(0.0, axis=2, sense=1, material='plate'))
top = O.bodies.append(wall(H, axis=2, sense=-1, material='plate'))
O.bodies[top].state.vel = (0, 0, -RATE * H)

curve = []


def record():
    down, up = O.forces.f(bottom)[2], O.forces.f(top)[2]
    step = O.iter + 1  # O.iter counts the finished steps
    curve.append((step, step * DT * RATE, (up - down) / 2 / (math.pi * R_CYLINDER**2)))


O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.1),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom6D(), Ig2_Wall_Sphere_ScGeom()],
        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=False, setCohesionOnNewContacts=False),
         Ip2_FrictMat_FrictMat_FrictPhys()],
        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(), Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0.3, gravity=(0, 0, 0)),
]
if OUT:
    O.engines = O.engines + [PyRunner(command='record()', iterPeriod=50, firstIterRun=49)]
O.dt = DT

for i, j in table('bonds.csv'):
    bond = createInteraction(int(i), int(j))
    p = bond.phys
    p.kn, p.ks, p.kr, p.ktw = K_N, K_S, K_BEND, K_TWIST
    p.normalAdhesion, p.shearAdhesion = TENSION, SHEAR
    p.cohesionBroken, p.fragile = False, True
    p.maxRollPl = p.maxTwistPl = -1  # moments stay elastic

cpu = time.process_time()
O.run(STEPS, True)
cpu = time.process_time() - cpu
n = len(O.bodies) - 2
print('RESULT particles %d steps %d cpu_s %.3f million_particle_steps_per_cpu_s %.3f' % (n, STEPS, cpu, n * STEPS / cpu / 1e6))

if OUT:
    with open(OUT, 'w') as f:
        f.write('step,strain,stress\n')
        for row in curve:
            f.write('%d,%.8g,%.8g\n' % row)
    window = [(e, s) for _, e, s in curve if 1e-3 <= e <= 4e-3]
    if len(window) > 2:
        me, ms = (sum(v) / len(window) for v in zip(*window))
        modulus = sum((e - me) * (s - ms) for e, s in window) / sum((e - me)**2 for e, _ in window)
        step, e, s = max(curve, key=lambda row: row[2])
        print('CHECK modulus %.1f peak %.3f at_strain_percent %.4f' % (modulus, s, 100 * e))
sys.stdout.flush()
os._exit(0)
