from knitcore.base.errors import CancelledError as CancelledError
from knitcore.base.errors import ConvergenceError as ConvergenceError
from knitcore.base.errors import InputError as InputError
from knitcore.base.errors import KnitcoreError as KnitcoreError
from knitcore.base.errors import UnravelledError as UnravelledError
from knitcore.chart.fabric import Direction as Direction
from knitcore.chart.fabric import Fabric as Fabric
from knitcore.chart.phases import quarter_phases as quarter_phases
from knitcore.chart.segments import SegmentCounts as SegmentCounts
from knitcore.chart.segments import SegmentMap as SegmentMap
from knitcore.chart.segments import segment_map as segment_map
from knitcore.chart.stitch_chart import StitchChart as StitchChart
from knitcore.cloth.flat.strip import strip_test as strip_test
from knitcore.materials.library import material as material
from knitcore.prediction.curve import curve as curve
from knitcore.prediction.predict import predict as predict
from knitcore.prediction.size import RelaxedSize as RelaxedSize
from knitcore.yarn.library.material_relaxation import relax as relax

__version__: str
