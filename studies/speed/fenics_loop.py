"""The paper's demonstration (Note 9) with FEniCS, each load step solved from zero on a new mesh.

Run by ``studies/speed/swatch.py`` with the Python that has Debian's ``python3-dolfin``; prints one
JSON line per mesh: cells a side, CPU seconds, energy.
"""

import json
import sys
import time

import dolfin as d

STIFFNESS = ((0.240872, 0.0362245, 0.0), (0.0362245, 0.0599528, 0.0), (0.0, 0.0, 0.01))
STIFFENING = ((1.16995, 0.0223765), (0.802057, 0.0219965))


def solve(cells: int, displacement: float) -> float:
    mesh = d.RectangleMesh(d.Point(0, 0), d.Point(3.15, 1.0), cells, cells, "crossed")
    space = d.VectorFunctionSpace(mesh, "Lagrange", 1)
    u, test, trial = d.Function(space), d.TestFunction(space), d.TrialFunction(space)
    held = [
        d.DirichletBC(space, d.Constant((0, 0)), "near(x[1], 0.0)"),
        d.DirichletBC(space, d.Constant((0, displacement)), "near(x[1], 1.0)"),
    ]
    tensor = d.sym(d.grad(u))
    strain = d.as_vector([tensor[0, 0], tensor[1, 1], 2 * tensor[0, 1]])
    density = d.dot(strain, d.Constant(STIFFNESS) * strain) / 2
    for component, (alpha, beta) in enumerate(STIFFENING):
        a, b, e = d.Constant(alpha), d.Constant(beta), strain[component]
        density += b * (a**2 * e**3 + a**3 * e**4)
    energy = density * d.dx
    force = d.derivative(energy, u, test)
    d.solve(force == 0, u, held, J=d.derivative(force, u, trial))
    return float(d.assemble(energy))


def main() -> None:
    d.set_log_level(40)
    solve(4, 0.1)  # compiles the forms
    for cells in map(int, sys.argv[1:]):
        begin = time.process_time()
        for step in range(1, 21):
            energy = solve(cells, 0.75 * step / 20)
        print(json.dumps([cells, time.process_time() - begin, energy]), flush=True)


if __name__ == "__main__":
    main()
