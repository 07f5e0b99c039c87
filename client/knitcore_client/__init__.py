"""A typed client of Knitcore's REST API, for scripts and notebooks.

Every operation is a method by its name, which takes the fields of the request (files as paths)
and returns a model of the answer. :class:`Client` waits for answers, :class:`AsyncClient` is
awaited; both are the same otherwise.

Examples
--------
::

    from knitcore_client import Client

    with Client("http://127.0.0.1:8737", token="…") as knit:
        print(knit.predict(chart="KPKP", material="acrylic").modulus_course_n_per_mm)
        law = knit.fit(test_course=Path("course.csv"), test_wale=Path("wale.csv"))
        design = knit.create("Cuff", "acrylic", "KPKP\\nKPKP")
        design = knit.save(design.id, design.document, design.revision)
        test = knit.run("stretch", chart=design.document.chart, material="acrylic",
                        direction="wale", strain=0.3)
"""

from knitcore_client.aio import AsyncClient
from knitcore_client.models import VERSION
from knitcore_client.sync import Client
from knitcore_client.wire import ProblemError

__version__ = VERSION

__all__ = ["AsyncClient", "Client", "ProblemError"]
