"""Units as engineers write them: ``Nms/rad``, ``in-lb-s/rad``, ``kg.m2``; one spelling for pint, and a pattern for editors."""

from __future__ import annotations

import re

__all__ = ["LONGEST", "advice", "spellings", "text_pattern"]

LONGEST = 40
"""Letters of a unit; no real one is longer, and a parser of units may take for ever on what is."""

_WORDS = {
    "N": "N mN daN kN MN GN lbf lb lbs klbf kip kips kgf tonf newton newtons",
    "m": "m mm cm dm km um µm in inch inches ft foot feet yd yard yards mile miles nmi thou",
    "kg": "kg g mg t tonne tonnes lb lbs lbm slug slugs",
    "s": "s ms sec second seconds min minute minutes h hr hour hours",
    "rad": "rad mrad radian radians deg ° degree degrees arcmin arcsec turn rev revolution revolutions grad",
    "Pa": "Pa hPa kPa MPa GPa TPa psi ksi Msi bar mbar atm",
}
"""Words for each unit that quantities are declared in."""

_ALSO = {
    "m/s": ("kt", "kts", "knot", "knots", "mph", "kph"),
    "rad/s": ("rpm",),
    "Pa": ("N/m^2",),
    "N/m^2": ("Pa",),
    "kg m^2": ("N m s^2",),
}
"""Other units or words for the same quantity."""

_EXPONENTS = str.maketrans({"²": "^2", "³": "^3", "⁴": "^4", "⁻": "^-", "¹": "1", "−": "-"})
_SIGNS = re.compile(r"\s*[*·⋅×]\s*")
_FORCE, _LENGTH = "(?:(?:da|[kMGm])?N|k?lbf|kgf|kip)", "(?:[mc]?m|in|ft)"
_GLUED = (
    (re.compile(rf"({_FORCE})({_LENGTH})(s?)"), r"\1 \2 \3"),
    (re.compile(rf"({_FORCE})(s)"), r"\1 \2"),
    (re.compile(r"(in|ft)(lbf|lbs|lb)()"), r"\1 \2 \3"),
    (re.compile(r"(lbf|lb)(in|ft)()"), r"\1 \2 \3"),
    (re.compile(r"(kg|slug)([mc]?m|in|ft)()"), r"\1 \2 \3"),
)
_WORD = r"[A-Za-zµμ°%_]+"
_POWER = re.compile(rf"({_WORD})(?:\s*\^\s*(-?[1-9]))?(?![\d^A-Za-z])")
_AIRSPEED = re.compile(r"K[ITCEG]A?S|K(?:GS|TGS)")


def spellings(unit_text: str) -> list[str]:
    """A unit in words that pint knows, the likeliest first; empty where the text can be no unit.

    Parameters
    ----------
    unit_text : str
        Such as ``in-lb-s/rad``.

    Returns
    -------
    list of str

    Examples
    --------
    >>> spellings("kNms/rad")
    ['kN m s/rad']
    """
    if len(unit_text) > LONGEST:
        return []
    text = _SIGNS.sub(" ", unit_text.replace("**", "^").translate(_EXPONENTS).replace("^^", "^"))
    text = re.sub(r"\bper\b", "/", text).strip(" .")
    text = re.sub(r"\b(kip|deg)s\b", r"\1", "1" + text if text.startswith("/") else text)
    text = re.sub(r"(?<=[A-Za-z])\s*[-.]\s*(?=[A-Za-zµμ°])", " ", text)  # N-m, N.m
    text = re.sub(r"(?<=[A-Za-z])(-?[1-9])", r"^\1", text)  # kg/m3, s-1
    text = re.sub(r"[A-Za-z]+", _taken_apart, text)
    if not re.fullmatch(r"(?:1\s*/\s*)?[u()/\s]*u[u()/\s]*", re.sub(r"\)\s*\^\s*-?[1-9](?!\d)", ")", _POWER.sub("u", text))):
        return []
    return [text, *([re.sub(r"\blbs?\b", "lbf", text)] if re.search(r"\blbs?\b", text) else [])]


def _taken_apart(match: re.Match[str]) -> str:
    word = match[0]
    for glued, apart in _GLUED:
        if glued.fullmatch(word):
            return glued.sub(apart, word).rstrip()
    return word


def advice(unit_text: str, target: str) -> list[str]:
    """Other spellings that were perhaps meant, such as ``kN`` for ``KN``.

    Parameters
    ----------
    unit_text : str
    target : str
        Unit in which the quantity is declared.

    Returns
    -------
    list of str
        Not all of them are units of the quantity.
    """
    if _AIRSPEED.fullmatch(unit_text.strip().upper()):
        return ["kt"]
    if unit_text.strip().casefold() in ("kmh", "kmph", "kmhr"):
        return ["km/h"]
    words = [word for name in _names(target) for word in _WORDS.get(name, "").split()] + list(_ALSO.get(target, ()))
    by_letters = {word.casefold(): word for word in reversed(words)}
    found = []
    for text in spellings(unit_text):
        found.append(re.sub(_WORD, lambda word: by_letters.get(word[0].casefold(), word[0]), text))
        for glued in spellings(re.sub(r"[A-Za-z]+", lambda word: _force_in_capitals(word[0]), text)):
            found.append(glued)
    return [text for text in dict.fromkeys(found) if text != unit_text]


def _force_in_capitals(word: str) -> str:
    """kNm for KNM and knm."""
    match = re.fullmatch(r"([km]?)n(m|mm|cm)?(s?)", word, re.IGNORECASE)
    if word.casefold().startswith("kg"):
        return word.casefold()
    if not match:
        return word
    prefix = "k" if match[1] in "Kk" and match[1] else match[1]
    return f"{prefix}N{(match[2] or '').lower()}{match[3].lower()}"


def _names(unit: str) -> list[str]:
    return re.findall(r"[A-Za-z]+", unit)


def text_pattern(unit: str) -> str:
    """Regular expression (ECMA 262) of text with a unit of the dimension of `unit`, for a JSON Schema.

    Parameters
    ----------
    unit : str
        Such as ``N m/rad``.

    Returns
    -------
    str
        It knows the spellings that are in use; what it refuses may still be a unit, what it takes is one.
    """
    number = r"[-+]?(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
    forms = [_form(unit)]
    for other in _ALSO.get(unit, ()):
        forms.append(_form(other) if set(_names(other)) <= set(_WORDS) else re.escape(other))
    return rf"^\s*{number}\s*(?:{'|'.join(forms)})\s*$"


def _form(unit: str) -> str:
    over, _, under = unit.partition("/")
    above, below = ([_factor(word) for word in part.split() if word != "1"] for part in (over, under))
    needed = "".join(f"(?=[^/]*?{word})" for word in above) if len(above) > 1 else ""
    top = rf"{needed}(?:(?:{'|'.join(above)})[\s*·.-]*)+" if above else r"(?:1\s*)?"
    if not below:
        return top
    powers = "|".join(_factor(word, -1) for word in under.split())
    bottom = rf"(?:\s*(?:/|per\s)\s*\(?\s*(?:{'|'.join(below)})\)?|[\s*·.-]*(?:{powers}))"
    # a torque per angle is a torque where radians go without saying
    return top + bottom + ("?" if under == "rad" and above else "" if len(below) == 1 else "+")


def _factor(word: str, sign: int = 1) -> str:
    name, _, power = word.partition("^")
    words = "|".join(sorted(_WORDS.get(name, name).split(), key=lambda text: -len(text)))
    exponent = sign * int(power or 1)
    raised = "²³⁴"[exponent - 2] if 2 <= exponent <= 4 else ""
    end = "" if exponent == 1 else rf"(?:(?:\^|\*\*)?{exponent}{'|' + raised if raised else ''})"
    return f"(?:{words}){end}"
