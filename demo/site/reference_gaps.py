#!/usr/bin/env python3
"""Lists warnings of Doxygen and public declarations without documentation.

Usage: reference_gaps.py SOURCE_DIR LOG…   (SOURCE_DIR: output of reference_source.py)

A comment documents a paragraph: the declarations below it up to the first blank line. Members of a documented record
need no comments. Exit status 1 if anything is listed.
"""
import pathlib
import re
import sys

WARNING = re.compile(r'^(.*?):(\d+): warning: (.*)$')
# Declarations that hosts never name (how the library reads a system's parameters), and self-explanatory members.
PLAIN = re.compile(r'operator|::(Packed)?Parameter<|Signature|Compound .*<|\((variable|typedef)\) of (struct|union)|'
                   r'\((friend|function)\) of (struct|union)|macro definition')
SAYS_ITSELF = re.compile(r'\b(size|empty|begin|end|data|front|back|~?[A-Z]\w*|is_\w+|has_\w+)\(.*\)[a-z ]*\(function\)')


def explained(lines, at):
    """Returns true if a Doxygen comment precedes that line in its paragraph."""
    for i in range(at, -1, -1):
        line = lines[i].strip()
        if line.startswith(('///', '/**')) or (i < at and '*/' in line):
            return True
        if line == '' or line in ('public:', 'private:'):
            return False
    return False


def main():
    files, left = {}, set()
    for log in sys.argv[2:]:
        for row in pathlib.Path(log).read_text().splitlines():
            found = WARNING.match(row)
            if not found:
                if row.strip() and 'No output formats selected' not in row:
                    left.add(row)
                continue
            file, line, text = found[1], int(found[2]), found[3]
            if 'potential recursive class relation' in text:
                continue  # a problem of Doxygen with Signature<decltype(&F::operator())>
            if 'is not documented' in text:
                if PLAIN.search(text) or SAYS_ITSELF.search(text):
                    continue
                lines = files.setdefault(file, pathlib.Path(file).read_text().split('\n'))
                if explained(lines, line - 1):
                    continue
            name = str(pathlib.Path(file)).split('/mobil/', 1)[-1]
            left.add(f'{name}:{line}: {text}')
    for each in sorted(left):
        print(each)
    return 1 if left else 0


sys.exit(main())
