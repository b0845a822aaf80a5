#!/usr/bin/env python3
"""Copies the installed headers and converts their comments for Doxygen.

Usage: reference_source.py INCLUDE_DIR OUT_DIR

Our headers document a file in the `//` block below `#pragma once`, a declaration in the block above it, and a field in
the comment after it, which can continue below. Each becomes a comment for Doxygen. Text that Doxygen would read as a
command or as HTML is escaped.
"""
import pathlib
import re
import sys

FORWARD = re.compile(r'^\s*(template <[^>]*> )?(struct|class|enum class) \w+;')
NOT_DOCUMENTATION = re.compile(r'^(namespace\b|IWYU|NOLINT|clang-format|extern )|^\}?\s*$')


def escaped(text):
    """Escapes plain text but not `code`, the only markup in our comments."""
    parts = re.split(r'(`[^`]*`)', text)
    for i in range(0, len(parts), 2):
        part = parts[i].replace('&', '&amp;').replace('<', '&lt;').replace('>', '&gt;')
        part = re.sub(r'([\\@#*%~])', r'\\\1', part)
        parts[i] = re.sub(r'\b([A-Z][a-z]+)(?=: )', r'%\1', part)  # "Threads: …" is a remark, not a class
    return ''.join(parts).replace('\\*', '&lowast;').replace('`&lt;', '`<')


def block(lines):
    """Converts the lines of a comment, without its marks. Indented lines are an example."""
    out, inside = [], False
    for line in lines:
        example = line.startswith('   ') and line.strip() != ''
        item = re.match(r'^\s*- ', line)
        if example and not inside and not item and (not out or out[-1] == '' or not out[-1].startswith('- ')):
            out.append('@code{.cpp}')
            inside = True
        elif inside and not example and line.strip():
            out.append('@endcode')
            inside = False
        out.append(line[1:] if inside else escaped(line.strip() if not example else line[1:].strip()))
    if inside:
        out.append('@endcode')
    return out


class Scopes:
    """The braces around a line: those of namespaces and records, and those of bodies and values."""

    def __init__(self):
        self.stack, self.text, self.parens = [], '', 0

    def body(self):
        return 'body' in self.stack

    def at_start(self):
        return self.parens == 0 and self.text.strip() == ''

    def feed(self, code):
        if code.startswith('#'):
            return
        for c in re.sub(r'"(\\.|[^"\\])*"|\'(\\.|[^\'\\])\'', '""', code) + ' ':
            if c == '{':
                head = re.sub(r'template\s*<[^{};]*?>\s*(?=(struct|class|constexpr|inline|void|\w))', '', self.text)
                record = re.match(r'\s*(typedef )?(struct|class|enum|union|namespace|inline namespace|extern "")\b', head)
                self.stack.append('scope' if record and '(' not in head and '=' not in head else 'body')
                self.text = ''
            elif c == '}':
                if self.stack:
                    self.stack.pop()
                self.text = ''
            elif c in '()':
                self.parens += 1 if c == '(' else -1
                self.text += c
            elif c == ';' or (c == ',' and self.parens == 0 and self.stack and self.is_enum()):
                self.text = ''
            elif c == ':' and re.match(r'\s*(public|private|protected)$', self.text):
                self.text = ''
            else:
                self.text += c

    def is_enum(self):
        return not self.body() and not re.search(r'[<\s]\w+\s', self.text.strip())


def cpp(text, stem):
    lines = text.split('\n')
    out, scopes, i = [], Scopes(), 0
    head, about = True, []
    namesake = re.compile(r'^(class|struct) ' + stem.title().replace('_', '') + r' (final )?[:{]')
    while i < len(lines):
        line = re.sub(r'^namespace mobil::inline v\w+', 'namespace mobil', lines[i])
        whole = re.match(r'^(\s*)//(/?)(<?)(.*)$', line)
        if line.startswith('#pragma once'):
            out.append('/// @file')
        elif whole and not scopes.body():
            comment = []
            while i < len(lines) and (found := re.match(r'^\s*///?(.*)$', lines[i])):
                comment.append(found[1])
                i += 1
            followed = i < len(lines) and lines[i].strip() != '' and not lines[i].lstrip().startswith('}')
            if (head or followed) and not NOT_DOCUMENTATION.match(comment[0].strip()):
                out += [whole[1] + '/// ' + each for each in block(comment)]
            else:
                out += [whole[1] + '//' + each for each in comment]
            if head:
                about, head = ['/// ' + each for each in block(comment)], False
                out.append('')
            continue
        else:
            if namesake.match(line) and not out[-1].startswith('///'):
                out += about  # a header with one class documents it at its head
            head = head and not line.strip()
            found = re.match(r'^(.*?\S)\s+//\s*(?!/)(.*)$', line) if '//' in line else None
            if found and '"' in found[1] and found[1].count('"') % 2:
                found = None
            start, indent = scopes.at_start(), re.match(r'\s*', line)[0]
            scopes_before = scopes.body()
            scopes.feed(found[1] if found else re.sub(r'//.*', '', line))
            if not found or scopes_before or FORWARD.match(line) or NOT_DOCUMENTATION.match(found[2]) or \
                    found[1].startswith('#') or re.match(r'^[\s}]*$', found[1]) or found[1].endswith('{'):
                out.append(line)
            else:
                said, column, blanks = [found[2]], line.index('//', len(found[1])), 0
                while i + 1 < len(lines) and (more := re.match(r'^(\s+)//\s(.*)$', lines[i + 1])) and \
                        len(more[1]) >= min(column, len(indent) + 8):
                    said.append(more[2])
                    i += 1
                    blanks += 1
                said = ' '.join(escaped(each.strip()) for each in said)
                if start:
                    out.append(f'{indent}/** {said} */ {found[1].strip()}')
                elif scopes.at_start():
                    out.append(f'{found[1]}  /**< {said} */')
                else:
                    out.append(f'{found[1]}  // {said}')
                out += [''] * blanks
        i += 1
    return '\n'.join(out)


def c(text):
    """Converts the C header: `/* … */` above or after a declaration, and chapter names between dashes."""
    chapters = []

    def comment(match):
        before, inner = match[1], match[2]
        chapter = re.match(r'^ -+ (.*?) -+ $', inner)
        if chapter:
            chapters.append(chapter[1])
            name = re.sub(r'\W+', '_', chapter[1].lower())
            end = '/** @} */ ' if len(chapters) > 1 else ''
            return f'{before}{end}/** @defgroup {name} {chapter[1]}\n@{{ */'
        rows = [re.sub(r'^\s*\* ?', ' ', row) if j else row for j, row in enumerate(inner.split('\n'))]
        code = before.strip()
        if code.startswith('#if') or code.startswith('#e'):
            return match[0]
        if not code:
            return before + '/**' + ('@file\n' if not text.index(match[0]) else '') + '\n'.join(block(rows)) + ' */'
        said = ' '.join(escaped(row.strip()) for row in rows)
        start = re.match(r'^\s*(typedef|struct|MOBIL_API|MOBIL_[A-Z_]+|const|unsigned|size_t|int|float|double|void|\w+) ?', before)
        if start and before.count('(') == before.count(')') and not code.startswith('#') and ';' in code + ';':
            indent = re.match(r'\s*', before)[0]
            return f'{indent}/** {said} */ {before.strip()}' + '\n' * inner.count('\n')
        return f'{before}/**< {said} */' + '\n' * inner.count('\n')

    out = re.sub(r'^([^\n]*?)/\*([\s\S]*?)\*/', comment, text, flags=re.M)
    last = out.rindex('#ifdef __cplusplus')
    return out[:last] + '/** @} */\n' + out[last:]


def main():
    source, out = map(pathlib.Path, sys.argv[1:3])
    for file in sorted(source.rglob('*.h')):
        name = file.relative_to(source)
        is_c = name.name == 'mobil.h' and len(name.parts) == 1
        if name.parts[0] == 'c':
            continue  # a part of mobil.h
        text = re.sub(r'#include <mobil/(c/\w+\.h)>\n', lambda part: (source / part[1]).read_text(), file.read_text())
        to = out / ('c' if is_c else 'cpp') / 'mobil' / name
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(c(text) if is_c else cpp(text, name.stem))


main()
