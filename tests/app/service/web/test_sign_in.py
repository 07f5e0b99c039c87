"""The pages that sign in."""

import re

from app.service.web.page import SOURCES
from app.service.web.reference import STYLE
from app.service.web.sign_in import sign_in_page, token_page

COLOUR = re.compile(r"--([a-z-]+): (light-dark\([^()]+\));")


def test_plain_pages_have_the_colours_of_the_studio() -> None:
    tokens = dict(COLOUR.findall((SOURCES / "styles" / "tokens.css").read_text()))
    colours = dict(COLOUR.findall(STYLE))
    assert len(colours) > 8
    assert colours == {name: tokens[name] for name in colours}


def test_what_was_wrong_stands_below_the_field_and_names_are_text() -> None:
    page = token_page(401, "This <b> is unknown.").body.decode()
    assert page.index("<input") < page.index('<p role="alert">This &lt;b&gt; is unknown.</p>')
    assert "Sign in as &lt;i&gt;?" in sign_in_page("<i>", "", "x", "/").body.decode()
