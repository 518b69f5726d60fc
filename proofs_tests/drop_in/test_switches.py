"""Switch strings: what is read is what is written, and what cannot be meant is refused by name."""

import re
import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from exactmesh.triangle import MEANINGS, Switch, SwitchError, Switches, TriangleWarning, parse, triangulate

pytestmark = pytest.mark.once


NUMBER = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
TOKEN = re.compile(rf"o2|S[0-9]*|[qa]{NUMBER}?|[prucDLsYejvngBPNEIOzCQVXiFlwWhA]")
GRAMMAR = re.compile(rf"(?:-?(?:{TOKEN.pattern})*\s+)*-?(?:{TOKEN.pattern})*")


def read_naively(text: str) -> Switches | None:
    """Return what a string means by its grammar, or None where it has no meaning."""
    if not GRAMMAR.fullmatch(text):
        return None
    words: list[str] = TOKEN.findall(text)
    letters = {{"L": "D", "W": "w"}.get(word[0], word[0]) for word in words}
    numbers = {letter: {float(word[1:]) for word in words if word[0] == letter and word[1:]} for letter in "qaS"}
    numbers["q"] |= {20.0 for word in words if word == "q"}
    numbers["S"] |= {0.0 for word in words if word == "S"}
    found = {letter: min(values, default=None) for letter, values in numbers.items()}
    clash = any(len(values) > 1 for values in numbers.values())
    endless = any(value == float("inf") for values in numbers.values() for value in values)
    steep = any(value > 40.0 for value in numbers["q"])
    if clash or endless or steep or found["a"] == 0.0 or ("w" in letters and not letters & set("prqauDs")):
        return None
    return Switches(
        frozenset(Switch(letter) for letter in letters),
        found["q"],
        found["a"],
        "a" in words,
        min(words.count("Y"), 2),
        None if found["S"] is None else int(found["S"]),
    )


def read_as_triangle_does(text: str) -> Iterator[str]:
    """Yield what is left when numbers end at the first other character, and unknown ones are skipped."""
    for word in re.findall(r"[qaS][0-9.]*|o2|.", text):
        if word[0] in set(Switch) | {"L", "W"}:
            yield word


TOKENS = st.sampled_from(
    [*(s.value for s in Switch if s.value != "o"), "o2", "L", "W", "q30", "a0.1", "a.5", "S7", "a2.", "Y"]
)
STRINGS = st.one_of(
    st.lists(st.one_of(TOKENS, st.sampled_from([" ", " -"])), max_size=8).map("".join),
    st.text(alphabet="pqraAuDYSeEo20.139 -+,wx\n", max_size=8),
    st.text(max_size=5),
)


@pytest.mark.obligation("T2", "a string of switches is read whole, by its grammar, or refused", method="property-based")
class TestGrammar:
    """A string is read as its grammar says, letter by letter, or it is refused; nothing in it is skipped."""

    @given(STRINGS)
    @example("pq30a0.1")
    @example("-pq30 -a0.1")
    @example("a1e")
    @example("a0.1aa")
    @example("YYY")
    @example("wq")
    @example("q40")
    def test_as_the_grammar_says(self, text: str) -> None:
        expected = read_naively(text)
        if expected is not None:
            assert parse(text) == expected
            return
        with pytest.raises(SwitchError) as caught:
            parse(text)
        assert caught.value.culprit
        assert text[caught.value.position :].startswith(caught.value.culprit)

    @given(STRINGS)
    def test_canonical_form(self, text: str) -> None:
        """What a string means has one name, that means the same."""
        expected = read_naively(text)
        if expected is not None:
            assert parse(str(expected)) == expected
            assert str(parse(str(expected))) == str(expected)

    @pytest.mark.parametrize("text", ["a1e-3", "a-1", "q30 a 0.1", "pxq", "a0,1"])
    def test_control_triangle_reads_more(self, text: str) -> None:
        """Triangle's own reading, which takes what has no meaning."""
        assert list(read_as_triangle_does(text))
        assert read_naively(text) is None

    def test_every_switch_has_a_meaning(self) -> None:
        """The table of the documentation is that of the library."""
        page = (Path(__file__).parents[2] / "docs" / "triangle.md").read_text(encoding="utf-8")
        rows = re.findall(r"^\| `([A-Za-z])` \| ([^|]*) \|$", page, re.MULTILINE)
        assert rows == [(switch.value, MEANINGS[switch]) for switch in Switch]


TRAPS = [
    ("a1e-3", "a1e-3", "write a0.001"),
    ("pq30a2.5E-2", "a2.5E-2", "write a0.025"),
    ("pa1e3", "a1e3", "write a1000"),
    ("q2e1", "q2e1", "write q20"),
    ("a1e-999999999999", "a1e-999999999999", "0.001 for 1e-3"),
    ("a-1", "a-1", "write a alone"),
    ("q-20", "q-20", "leave the sign out"),
    ("S+5", "S+5", "leave the sign out"),
    ("a0,1", "a0,1", "write a0.1"),
    ("a 0.1", "0.1", "without a space"),
    ("p30", "30", "belongs to no switch"),
    ("p.5", ".5", "belongs to no switch"),
    ("px", "x", "no switch"),
    ("pé", "é", "no switch"),
    ("p-q", "-", "no switch"),
    ("q1.2.3", "q1.2.3", "not a number"),
    ("a.", "a.", "not a number"),
    ("a0", "a0", "greater than 0"),
    ("a0.000", "a0.000", "greater than 0"),
    ("a" + "9" * 400, "a" + "9" * 400, "largest double"),
    ("pq60", "q60", "ask for 40 at most"),
    ("q40.5", "q40.5", "ask for 40 at most"),
    ("S1.5", "S1.5", "integer"),
    ("o", "o", "only o2"),
    ("o3", "o3", "only o2"),
    ("q20q30", "q30", "another number already"),
    ("a0.1a0.2", "a0.2", "another number already"),
    ("w", "w", "not offered"),
    ("eW", "W", "not offered"),
]


class TestTraps:
    """What Triangle misreads is refused; the error names the culprit, its place, and what to write."""

    @pytest.mark.parametrize(("text", "culprit", "remedy"), TRAPS)
    def test_named(self, text: str, culprit: str, remedy: str) -> None:
        with pytest.raises(SwitchError) as caught:
            parse(text)
        error = caught.value
        assert (error.culprit, error.switches) == (culprit, text)
        assert text[error.position : error.position + len(culprit)] == culprit
        assert remedy in str(error)

    @pytest.mark.parametrize(("text", "area"), [("a0.001", 0.001), ("a1000", 1000.0), ("a0.025", 0.025)])
    def test_the_remedy_is_what_was_meant(self, text: str, area: float) -> None:
        assert parse(text).max_area == area


class TestWarnings:
    """A switch that means something else here says so; one that means the same says nothing."""

    @pytest.mark.parametrize("text", ["i", "F", "l", "X", "V", "h", "ps", "pqw", "A", "v", "g", "pa"])
    def test_said(self, text: str) -> None:
        square = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)], "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}
        with pytest.warns(TriangleWarning, match=re.escape(text[-1])) as caught:
            triangulate(square, text)
        assert [warning.filename for warning in caught] == [__file__]

    def test_nothing_to_say(self) -> None:
        square = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)], "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            triangulate(square, "Qzpq20a0.5enDYYS9jo2BIOCc")
