@HEADER@
#
# Run:  yade -n -x -j1 unconfined_compression.py     (written for YADE 2023.02a)
# Reads spheres.csv and bonds.csv beside it, writes curve.csv; tilth_curve.csv is our own curve of the same specimen.
#
# How our laws are translated (L = r_a + r_b, r = min(r_a, r_b), A = pi (lambda r)^2, I = pi (lambda r)^4 / 4):
#   contact   kn = E_c pi r^2 / L, at a platen E_c pi r; ks = kn / kappa; |F_s| <= mu F_n
#   bond      kn = E_b A / L, ks = kn / kappa_b, kr = E_b I / L, ktw = (E_b / kappa_b) 2 I / L
#   strength  T/A + beta |M_b| R/I <= sigma_c and |F_s|/A + beta |M_t| R/(2 I) <= c_b + sigma tan(phi_b)
#   overlaps of the packing carry no force: unp = the distance at the start, in pairs and at platens
#   damping   NewtonIntegrator(damping = alpha)
# YADE's bond law breaks on forces only and has one spring per pair. A watch in Python, called every WATCH_EVERY steps, therefore
# applies the strength, adds the contact's spring while the spheres press, lets it slip, and gives every contact its constants.
# What YADE cannot express, and this deck does not: strength, slip beside a bond and constants of contacts that form later are looked
# at every WATCH_EVERY steps, not in each (a larger number is faster and breaks later: see the manual page on export); moments
# follow YADE's total rotation, ours are incremental.
import csv, math, os, sys
from yade.utils import *

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
DENSITY = @GRAIN_DENSITY_KG_PER_M3@
CONTACT_MODULUS, CONTACT_RATIO, FRICTION = @CONTACT_MODULUS_PA@, @CONTACT_STIFFNESS_RATIO@, @CONTACT_FRICTION@
WALL_FRICTION = @WALL_FRICTION@
BOND_MODULUS, BOND_RATIO, BOND_RADIUS = @BOND_MODULUS_PA@, @BOND_STIFFNESS_RATIO@, @BOND_RADIUS_MULTIPLIER@
TENSION, COHESION, BOND_ANGLE = @BOND_TENSILE_STRENGTH_PA@, @BOND_COHESION_PA@, @BOND_FRICTION_ANGLE_RAD@
MOMENT_SHARE, DAMPING = @BOND_MOMENT_CONTRIBUTION@, @LOCAL_DAMPING@
RADIUS, PLATEN_SPEED = @SPECIMEN_RADIUS_M@, @PLATEN_SPEED_M_PER_S@  # closing speed, each platen moves at half of it
BOTTOM, TOP = @PLATEN_BOTTOM_M@, @PLATEN_TOP_M@
TIME_STEP, FINAL_STRAIN = @TIME_STEP_S@, @FINAL_STRAIN@
OUTPUT_EVERY, WATCH_EVERY = @OUTPUT_EVERY_STEPS@, 2
UNLIMITED = 1e300
HEIGHT = TOP - BOTTOM


def table(name):
    with open(os.path.join(HERE, name)) as f:
        rows = csv.reader(line for line in f if not line.startswith('#'))
        next(rows)
        return list(rows)


spheres = [[float(v) for v in row] for row in table('spheres.csv')]
pairs = [(int(row[0]), int(row[1])) for row in table('bonds.csv')]

# Two different bodies get kn = 2 y_a r_a y_b r_b / (y_a r_a + y_b r_b), until the watch has seen them.
O.materials.append(CohFrictMat(young=math.pi / 2 * CONTACT_MODULUS, poisson=1 / CONTACT_RATIO, density=DENSITY,
                               frictionAngle=math.atan(FRICTION), momentRotationLaw=True, normalCohesion=0,
                               shearCohesion=0, label='grain'))
O.materials.append(CohFrictMat(young=1e30, poisson=0.5, density=DENSITY, frictionAngle=math.atan(WALL_FRICTION),
                               momentRotationLaw=False, normalCohesion=0, shearCohesion=0, label='platen'))

for x, y, z, r in spheres:
    O.bodies.append(sphere((x, y, z), r, material='grain'))
    O.bodies[-1].state.vel = (0, 0, PLATEN_SPEED * (0.5 - (z - BOTTOM) / HEIGHT))  # uniform straining, no shock
half = (4 * RADIUS, 4 * RADIUS, 0.1 * HEIGHT)
bottom = O.bodies.append(box((0, 0, BOTTOM - half[2]), half, fixed=True, material='platen'))
top = O.bodies.append(box((0, 0, TOP + half[2]), half, fixed=True, material='platen'))
top_start = O.bodies[top].state.pos[2]
bottom_start = O.bodies[bottom].state.pos[2]
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()], verletDist=0.1 * spheres[0][3]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(), Ig2_Box_Sphere_ScGeom6D()],
                    [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                    [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()]),
    NewtonIntegrator(damping=DAMPING, gravity=(0, 0, 0)),
    PyRunner(command='watch()', iterPeriod=WATCH_EVERY),
    PyRunner(command='record()', iterPeriod=1),
]
O.dt = TIME_STEP


def contact_stiffness(a, b):
    if max(a, b) >= len(spheres):
        return math.pi * CONTACT_MODULUS * spheres[min(a, b)][3]
    ra, rb = spheres[a][3], spheres[b][3]
    return CONTACT_MODULUS * math.pi * min(ra, rb)**2 / (ra + rb)


class Contact:
    """Constants of a contact beside or without a bond; reference = overlap that carries no force."""

    def __init__(self, a, b, reference):
        self.kn = contact_stiffness(a, b)
        self.ks = self.kn / CONTACT_RATIO
        self.friction = WALL_FRICTION if max(a, b) >= len(spheres) else FRICTION
        self.reference = reference

    def give_to(self, p):
        p.kn, p.ks, p.unp = self.kn, self.ks, self.reference
        p.tangensOfFrictionAngle = self.friction
        p.normalAdhesion = p.shearAdhesion = 0
        p.cohesionBroken = True
        # With a reference the pair must stay known while it is open: a yielding spring at zero force does that.
        p.fragile = self.reference == 0


class Bond:
    def __init__(self, a, b):
        self.interaction = createInteraction(a, b)
        self.ids = tuple(sorted((a, b)))
        ra, rb = spheres[a][3], spheres[b][3]
        length, least = ra + rb, min(ra, rb)
        self.rest = self.interaction.geom.penetrationDepth  # overlap without force in the bond; < 0 for a gap
        self.contact = Contact(a, b, max(self.rest, 0.0))
        self.radius = BOND_RADIUS * least
        self.area = math.pi * self.radius**2
        self.i = math.pi * self.radius**4 / 4
        self.kn = BOND_MODULUS * self.area / length
        self.ks = self.kn / BOND_RATIO
        p = self.interaction.phys
        p.kr = BOND_MODULUS * self.i / length
        p.ktw = BOND_MODULUS / BOND_RATIO * 2 * self.i / length
        p.normalAdhesion = p.shearAdhesion = UNLIMITED  # the watch decides
        p.cohesionBroken, p.fragile, p.maxRollPl, p.maxTwistPl = False, True, -1, -1
        self.contact_shear = Vector3(0, 0, 0)  # the contact's part of p.shearForce
        self.last_shear = Vector3(0, 0, 0)     # p.shearForce when last seen
        self.press(False)

    def press(self, pressed):
        """One spring for bond and contact: at the change both ways give the same force."""
        self.pressed = pressed
        p, c = self.interaction.phys, self.contact
        p.kn = self.kn + (c.kn if pressed else 0)
        p.ks = self.ks + (c.ks if pressed else 0)
        p.unp = (self.kn * self.rest + c.kn * c.reference) / p.kn if pressed else self.rest

    def slip(self, p, overlap):
        """Splits the shear force into bond and contact, cuts the contact's part at friction; the bond's part."""
        total, c = p.shearForce, self.contact
        if not self.pressed:
            return total
        self.contact_shear += (total - self.last_shear) * (c.ks / p.ks)
        of_bond = total - self.contact_shear
        limit = c.friction * max(c.kn * (overlap - c.reference), 0.0)
        size = self.contact_shear.norm()
        if size > limit:
            self.contact_shear *= limit / size
            p.shearForce = of_bond + self.contact_shear
        return of_bond

    def survives(self):
        g, p = self.interaction.geom, self.interaction.phys
        of_bond = self.slip(p, g.penetrationDepth)
        pressure = (g.penetrationDepth - self.rest) * self.kn / self.area  # compression positive
        shear = of_bond.norm()
        bending, torsion = p.moment_bending.norm(), p.moment_twist.norm()
        tension = -pressure + MOMENT_SHARE * bending * self.radius / self.i
        slide = shear / self.area + MOMENT_SHARE * torsion * self.radius / (2 * self.i)
        if tension > TENSION or slide > COHESION + pressure * math.tan(BOND_ANGLE):
            p.shearForce = self.contact_shear  # the bond's part goes
            self.contact.give_to(p)
            return False
        if (g.penetrationDepth > self.contact.reference) != self.pressed:
            self.press(not self.pressed)
            self.contact_shear = Vector3(0, 0, 0)
            p.shearForce = of_bond
        self.last_shear = Vector3(p.shearForce)
        return True


bonds = [Bond(a, b) for a, b in pairs]
bonded = {b.ids for b in bonds}
contacts = {b.ids: b.contact for b in bonds}
for platen, level, sense in ((bottom, BOTTOM, 1), (top, TOP, -1)):
    for k, (x, y, z, r) in enumerate(spheres):
        overlap = r - sense * (z - level)
        if overlap > 0:
            ids = (k, platen)
            contacts[ids] = Contact(*ids, overlap)
            contacts[ids].give_to(createInteraction(*ids).phys)
O.bodies[top].state.vel = (0, 0, -PLATEN_SPEED / 2)
O.bodies[bottom].state.vel = (0, 0, PLATEN_SPEED / 2)


def watch():
    global bonds
    kept = [b for b in bonds if b.survives()]
    if len(kept) != len(bonds):
        bonds = kept
        bonded.clear()
        bonded.update(b.ids for b in bonds)
    for i in O.interactions:
        ids = (i.id1, i.id2) if i.id1 < i.id2 else (i.id2, i.id1)
        if ids in bonded:
            continue
        if ids not in contacts:
            contacts[ids] = Contact(*ids, 0.0)
        c, p = contacts[ids], i.phys
        if p.kn != c.kn:
            c.give_to(p)
        elif p.unp != c.reference:
            p.unp = c.reference


curve = []
force_sum = 0.0


def record():
    global force_sum
    force_sum += (O.forces.f(top)[2] - O.forces.f(bottom)[2]) / 2
    if O.iter % OUTPUT_EVERY == 0:
        closed = (top_start - O.bodies[top].state.pos[2]) + (O.bodies[bottom].state.pos[2] - bottom_start)
        strain = (closed - 0.5 * OUTPUT_EVERY * TIME_STEP * PLATEN_SPEED) / HEIGHT  # middle of the interval
        curve.append((strain, force_sum / OUTPUT_EVERY / (math.pi * RADIUS**2), len(pairs) - len(bonds)))
        force_sum = 0.0


O.run(int(FINAL_STRAIN * HEIGHT / (PLATEN_SPEED * TIME_STEP)), True)
with open(os.path.join(HERE, 'curve.csv'), 'w') as f:
    f.write('axial_strain,axial_stress_Pa,bonds_broken\n')
    for row in curve:
        f.write('%.8g,%.8g,%d\n' % row)
strain, peak, broken = max(curve, key=lambda row: row[1])
print('peak_stress_Pa %.6g strain_at_peak %.6g bonds_broken %d of %d' % (peak, strain, len(pairs) - len(bonds), len(pairs)))
sys.stdout.flush()
os._exit(0)
