"""A user's own materials over REST: added, given back as a file, removed."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request

from knitcore.materials.material_document import MaterialDocument

from ...context import Context
from ...operations.yarn.materials import MaterialSummary, summary
from ..designs.parameters import MISSING, Owner
from ..problems import NotFoundError
from ..store.material_store import MaterialStore
from ..web.bodies import BoundedRoute

router = APIRouter(route_class=BoundedRoute, tags=["materials"], responses=MISSING)


async def _store(request: Request) -> MaterialStore:
    return MaterialStore(request.app.state.database)


Here = Annotated[MaterialStore, Depends(_store)]
Identifier = Annotated[str, Path(max_length=200, examples=["acrylic"])]


@router.post("/materials", status_code=201, summary="Add a material of your own")
def post_material(body: MaterialDocument, owner: Owner, store: Here) -> MaterialSummary:
    """Add a material, or replace one of yours with the same identifier. Everybody on this service
    can use it."""
    return summary(store.keep(body, owner), added_by_you=True)


@router.get("/materials/{identifier}/document", summary="A material as a file")
def get_material_document(identifier: Identifier, request: Request) -> MaterialDocument:
    """Return a material as a file, which `knitcore` reads and which you can add as your own."""
    context: Context = request.app.state.answers.context()
    material = context.material(identifier)
    plain = material.identifier.removeprefix("own:").rpartition(".")
    document = MaterialDocument.from_material(material)
    return document.model_copy(update={"identifier": plain[0] or document.identifier})


@router.delete("/materials/{identifier}", status_code=204, summary="Remove a material of your own")
def delete_material(identifier: Identifier, owner: Owner, store: Here) -> None:
    """Remove a material. Designs that use it keep its name and ask for another one."""
    if not store.remove(identifier, owner):
        raise NotFoundError(
            f"You added no material {identifier}.",
            field="identifier",
            remedy="Ask whoever added it, or choose another one.",
        )
