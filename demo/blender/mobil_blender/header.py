"""ctypes declarations from mobil.h: constants, structs and functions."""

from __future__ import annotations

import ctypes
import pathlib
import re

_SCALARS = {
    "int": ctypes.c_int,
    "unsigned int": ctypes.c_uint,
    "size_t": ctypes.c_size_t,
    "float": ctypes.c_float,
    "double": ctypes.c_double,
}


class Header:
    """Declarations of a header: `constants` by name, `structs` (ctypes.Structure) by name, and `functions`, which are
    pairs of result and argument types by name."""

    def __init__(self, text: str) -> None:
        code = re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)
        self.constants: dict[str, int] = {
            name: int(value) for name, value in re.findall(r"^#define (MOBIL_\w+) (\d+)\s*$", code, re.MULTILINE)
        }
        code = re.sub(r"^\s*#(?:.*\\\n)*.*$", "", code, flags=re.MULTILINE)
        code = re.sub(r"MOBIL_RENAMED\((\w+), (\w+), \w+\)", r"\1 \2", code)
        code = re.sub(r"MOBIL_DEPRECATED\(.*?\)", "", code)
        for body in re.findall(r"\benum\s*\{([^}]*)\}", code):
            self._enumerate(body)
        self.structs: dict[str, type[ctypes.Structure]] = {}
        for body, name in re.findall(r"typedef struct \w+\s*\{([^}]*)\}\s*(\w+);", code):
            fields = [field for line in body.split(";") if line.strip() for field in self._fields(line)]
            self.structs[name] = type(name, (ctypes.Structure,), {"_fields_": fields})
        self.functions = {
            name: (self._result(result.strip()), self._arguments(arguments))
            for result, name, arguments in re.findall(r"MOBIL_API\s+([\w\s]+?[\s*]+)(mobil_\w+)\(([^)]*)\);", code)
        }

    def _enumerate(self, body: str) -> None:
        following = 0
        for entry in filter(str.strip, body.split(",")):
            name, _, value = (part.strip() for part in entry.partition("="))
            self.constants[name] = self._number(value) if value else following
            following = self.constants[name] + 1

    def _number(self, text: str) -> int:
        return self.constants[text] if text in self.constants else int(text)

    def _type(self, name: str):
        bare = " ".join(re.sub(r"\b(?:const|struct)\b", "", name).split())
        known = _SCALARS.get(bare) or self.structs.get(bare)
        if known is None:
            raise ValueError(f"mobil.h: unknown type {bare}")
        return known

    def _fields(self, line: str) -> list[tuple[str, object]]:
        """Returns the fields of one declaration, such as "float place[3], heading_rad"."""
        function = re.search(r"\(\*(\w+)\)\s*\(", line)
        if function:
            return [(function[1], ctypes.c_void_p)]
        base, rest = re.match(r"\s*((?:(?:const|struct)\s+)*(?:unsigned\s+)?\w+)\s*(.*)", line, re.DOTALL).groups()
        fields = []
        for one in rest.split(","):
            star, name, count = re.fullmatch(r"\s*(\**)\s*(\w+)\s*(?:\[(\w+)\])?\s*", one).groups()
            kind = self._result(f"{base} {star}".strip())
            fields.append((name, kind * self._number(count) if count else kind))
        return fields

    def _result(self, text: str):
        if "*" in text:
            return ctypes.c_char_p if re.match(r"const char\b", text) else ctypes.c_void_p
        return None if text == "void" else self._type(text)

    def _arguments(self, text: str) -> list:
        return [] if text.strip() == "void" else [self._argument(one.strip()) for one in text.split(",")]

    def _argument(self, text: str):
        if "*" in text or "[" in text:
            return ctypes.c_void_p
        words = text.split()
        kind = " ".join(words[:-1]) if len(words) > 1 else text
        try:
            return self._type(kind)
        except ValueError:
            return ctypes.c_void_p  # a typedef of a function


def read(path: pathlib.Path) -> Header:
    """Reads mobil.h and the parts that it includes, which are in the folder c beside it."""
    text = path.read_text(encoding="utf-8")
    return Header(
        re.sub(
            r"#include <mobil/(c/\w+\.h)>",
            lambda part: (path.parent / part[1]).read_text(encoding="utf-8"),
            text,
        )
    )
