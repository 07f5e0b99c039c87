from knitcore.chart import StitchChart as StitchChart
from knitcore.errors import CancelledError as CancelledError
from knitcore.errors import ConvergenceError as ConvergenceError
from knitcore.errors import InputError as InputError
from knitcore.errors import KnitcoreError as KnitcoreError
from knitcore.errors import UnravelledError as UnravelledError
from knitcore.fabric import Direction as Direction
from knitcore.fabric import Fabric as Fabric
from knitcore.materials.library import material as material
from knitcore.phases import quarter_phases as quarter_phases
from knitcore.prediction.curve import curve as curve
from knitcore.prediction.predict import predict as predict
from knitcore.prediction.size import RelaxedSize as RelaxedSize
from knitcore.segments import SegmentCounts as SegmentCounts
from knitcore.segments import SegmentMap as SegmentMap
from knitcore.segments import segment_map as segment_map
from knitcore.swatch.strip import strip_test as strip_test
from knitcore.yarnlibrary.relaxation import relax as relax

__version__: str
