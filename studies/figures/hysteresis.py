"""Draw the figure of docs/yarn-level.md: ``python -m studies.figures.hysteresis``."""

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.study.hysteresis import hysteresis
from knitcore.yarn.study.relax import relax
from studies.figures.plot import FABRICS, MUTED, chart, name_fabrics, save

COEFFICIENT, STRAIN, TOP_N_PER_MM = 0.26, 0.5, 0.2


def main() -> None:
    axes = chart("strain along the rows", "stress, N/mm", xlim=(0, STRAIN), ylim=(0, TOP_N_PER_MM))
    for fabric in Fabric:
        entry = sample("acrylic", fabric)
        chart_of_fabric = StitchChart.of_fabric(fabric, 2, 2)
        rest = relax(chart_of_fabric, entry.yarn, entry.loop_length_mm, branch="mirrored")
        loop = hysteresis(rest, "course", STRAIN, COEFFICIENT, cycles=2)
        for leg in loop.legs:
            axes.plot(leg.strain, leg.stress_n_per_mm, color=FABRICS[fabric], linewidth=1.4)
        smooth = hysteresis(rest, "course", STRAIN, 0.0, cycles=1).legs[0]
        axes.plot(smooth.strain, smooth.stress_n_per_mm, ":", color=FABRICS[fabric], linewidth=1.4)
        print(
            f"{fabric}: {loop.lost_share:.0%} lost, strain {loop.left_strain:.3f} left, "
            f"closes within {loop.closes_within:.1%}"
        )
    name_fabrics(axes, *axes.plot([], [], ":", color=MUTED, label="no friction"))
    save(axes, "hysteresis")


if __name__ == "__main__":
    main()
