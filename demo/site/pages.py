#!/usr/bin/env python3
"""Makes the site's pages: the repository's documents, what they link to, and Doxygen's pages in the same frame.

Usage: pages.py REPOSITORY REFERENCE OUT

A document lies where it lies in the repository, README.md as index.html. A link to a file that is no document and no
picture leads to a page of its text; one to a folder, to a list of what is in it.
"""
import html
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

# The navigation's chapters, in reading order. Documents that are not named follow at the end.
CHAPTERS = [
    ('Begin', ['README.md', 'demo/README.md', 'demo/gallery/README.md', 'demo/web/README.md']),
    ('Use it', ['systems/README.md', 'demo/examples/README.md', 'systems/python/README.md', 'systems/javascript/README.md',
                'assets/export/README.md', '@reference']),
    ('Understand it', ['ARCHITECTURE.md', 'assets/gait/README.md', 'assets/reference/README.md', 'tests/README.md']),
    ('The project', ['CHANGELOG.md', 'CONTRIBUTING.md', 'SECURITY.md']),
]
REFERENCE = [('Reference: Simulation', 'reference/cpp/classmobil_1_1Simulation.html'),
             ('Reference: all C++ types', 'reference/cpp/annotated.html'),
             ('Reference: all C++ headers', 'reference/cpp/files.html'),
             ('Reference: C', 'reference/c/mobil_8h.html')]
# Doxygen's lists of everything by name, and of a class' members once more.
LISTS = re.compile(r'index\.html|globals|functions|namespacemembers|graph_legend|.*-members\.html')
PICTURES = {'.png', '.svg', '.jpg', '.webp', '.gif', '.mp4'}
SKIPPED = {'build', 'out', '.git', '.cache', '.ci', 'node_modules'}


def slug(text, taken):
    """The anchor of a heading, as code hosts make it."""
    plain = html.unescape(re.sub(r'<[^>]*>', '', text)).strip().lower()
    name = re.sub(r'[^\w\- ]', '', plain).replace(' ', '-')
    if name in taken:
        taken[name] += 1
        return f'{name}-{taken[name]}'
    taken[name] = 0
    return name


class Site:
    def __init__(self, repository, reference, out):
        self.root, self.reference, self.out = repository.resolve(), reference, out.resolve()
        self.documents = sorted(path.relative_to(self.root).as_posix() for path in self.root.rglob('*.md')
                                if not SKIPPED & set(path.relative_to(self.root).parts))
        self.titles = {each: self.title(each) for each in self.documents}
        self.written = set()

    def title(self, document):
        first = (self.root / document).read_text().split('\n', 1)[0]
        return first.lstrip('# ').replace('`', '')

    @staticmethod
    def page_of(document):
        name = document[:-len('.md')]
        return name[:-len('README')] + 'index.html' if name.endswith('README') else name + '.html'

    def navigation(self, page):
        """The column of all pages, as seen from one."""
        left = [each for each in self.documents if not any(each in names for _, names in CHAPTERS)]
        rows = []
        for chapter, names in CHAPTERS:
            items = []
            for name in names + (left if chapter == 'The project' else []):
                if name == '@reference':
                    items += REFERENCE
                elif name in self.titles:
                    items.append((self.titles[name], self.page_of(name)))
            if chapter == 'The project' and (self.root / 'LICENSE').is_file():
                items.append(('Licence', self.shown(self.root / 'LICENSE')))
            if chapter == 'Begin' and (self.root / 'build/page/index.html').exists():
                items.append(('Try it in the browser', 'page/index.html'))
            if items:
                rows.append(f'<h2>{chapter}</h2>\n<ul>')
                for title, target in items:
                    here = ' aria-current="page"' if target == page else ''
                    rows.append(f'<li><a href="{self.relative(target, page)}"{here}>{html.escape(title)}</a></li>')
                rows.append('</ul>')
        return '\n'.join(rows)

    @staticmethod
    def relative(target, page):
        return os.path.relpath(target, os.path.dirname(page) or '.')

    def write(self, page, title, body, kind='document'):
        to = self.out / page
        to.parent.mkdir(parents=True, exist_ok=True)
        top = self.relative('.', page)
        name = title if title == 'mobil' else f'{title} – mobil'
        to.write_text(f'''<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{html.escape(name)}</title>
<link rel="stylesheet" href="{top}/style.css">
</head>
<body>
<a class="skip" href="#content">To the text</a>
<header><a href="{top}/index.html">mobil</a></header>
<input type="checkbox" id="menu"><label for="menu">All pages</label>
<nav aria-label="All pages">
{self.navigation(page)}
</nav>
<main id="content" class="{kind}">
{body}
</main>
</body>
</html>
''')
        self.written.add(page)

    def shown(self, path):
        """Where a file or folder of the repository is on the site; puts it there."""
        name = path.relative_to(self.root).as_posix()
        if path.is_dir():
            if name != '.' and f'{name}/README.md' not in self.documents:
                page = f'{name}/index.html'
                if page not in self.written:
                    self.written.add(page)
                    rows = [f'<li><a href="{urllib.parse.quote(self.relative(self.shown(each), page))}">{html.escape(each.name)}</a></li>'
                            for each in sorted(path.iterdir())]
                    self.write(page, name, f'<h1>{html.escape(name)}</h1>\n<ul>\n' + '\n'.join(rows) + '\n</ul>')
                return page
            return 'index.html' if name == '.' else f'{name}/index.html'
        if name in self.documents:
            return self.page_of(name)
        if path.suffix in PICTURES:
            to = self.out / name
            if not to.exists():
                to.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, to)
            return name
        page = name + '.html'
        if page not in self.written:
            self.written.add(page)
            text = html.escape(path.read_text(errors='replace'))
            self.write(page, name, f'<h1>{html.escape(name)}</h1>\n<pre><code>{text}</code></pre>')
        return page

    def document(self, document):
        page, source = self.page_of(document), self.root / document
        body = subprocess.run(['cmark-gfm', '-e', 'table', '-e', 'strikethrough', '-e', 'autolink', source], check=True,
                              capture_output=True, text=True).stdout
        taken = {}
        body = re.sub(r'<h([1-6])>(.*?)</h\1>', lambda m: '<h{0} id="{1}">{2}</h{0}>'.format(
            m[1], slug(m[2], taken), m[2]), body, flags=re.S)

        def link(match):
            address = html.unescape(match[2])
            parts = urllib.parse.urlsplit(address)
            if parts.scheme or parts.netloc or not parts.path:
                return match[0]
            target = (source.parent / urllib.parse.unquote(parts.path)).resolve()
            if not target.exists() or (self.root not in target.parents and target != self.root):
                return match[0]  # links.py names it
            there = urllib.parse.quote(self.relative(self.shown(target), page))
            return f'{match[1]}="{there}{"#" + parts.fragment if parts.fragment else ""}"'

        body = re.sub(r'\b(href|src)="([^"]*)"', link, body)
        def code(match):
            """A file or a header that is named becomes a link to it."""
            if match[1]:
                return match[0]
            name = html.unescape(match[2])
            header = re.fullmatch(r'<mobil/(?:.*/)?(\w+)\.h>', name)
            if header:
                there = f'reference/{"c" if header[1] == "mobil" else "cpp"}/{header[1].replace("_", "__")}_8h.html'
                if not (self.reference / there.split('/', 1)[1]).exists():
                    return match[0]
            else:
                files = [folder / name for folder in (self.root, source.parent) if '/' in name and (folder / name).is_file()]
                if not files or SKIPPED & set(pathlib.Path(name).parts):
                    return match[0]
                there = self.shown(files[0].resolve())
            return f'<a href="{urllib.parse.quote(self.relative(there, page))}"><code>{match[2]}</code></a>'

        body = re.sub(r'(<a [^>]*>(?:(?!</a>).)*</a>)|<code>([^<\s]+)</code>', code, body, flags=re.S)
        body = re.sub(r'<table>.*?</table>', lambda m: f'<div class="wide">{m[0]}</div>', body, flags=re.S)
        self.write(page, self.titles[document], body)

    def reference_pages(self, language):
        """Doxygen's pages: what it wrote between its header and its footer, in our frame."""
        folder = self.reference / language
        for file in sorted(folder.glob('*.html')):
            text = file.read_text()
            title = html.unescape(re.search(r'<title>(?:[^<:]*: )?(.*?)</title>', text, re.S)[1])
            start = text.find('<div class="header">')
            end = text.rfind('<!-- contents -->')
            if start < 0 or end < 0 or LISTS.match(file.name):
                continue
            body = re.sub(r'<img[^>]*>|<script.*?</script>', '', text[start:end], flags=re.S)
            body = re.sub(r'^<div class="ttc".*$|<h2 class="groupheader">Detailed Description</h2>', '', body, flags=re.M)
            kind = re.compile(r' (Class|Struct)( Template)? Reference')
            title, body = kind.sub('', title), kind.sub('', body, count=1)
            # An argument is no member of the same name.
            body = re.sub(r'(?<=[ ;*])<a class="el"[^>]*>([a-z]\w*)</a>(?=(</em>)?[,)=])', r'\1', body)
            body = re.sub(r'(<td class="paramname"><em>)<a [^>]*>(\w+)</a>', r'\1\2', body)
            body = re.sub(r'<div class="summary">.*?</div>', '', body, flags=re.S)
            body = re.sub(r'<a href="([^"]*)">List of all members</a>', '', body)
            body = re.sub(r'<a [^>]*href="([^"#]*)[^"]*"[^>]*>(.*?)</a>',
                          lambda m: m[2] if LISTS.match(m[1]) else m[0], body, flags=re.S)
            body = re.sub(r'<span [^>]*(class="arrow"|style="width)[^>]*>[^<]*</span>', '', body)
            body = re.sub(r'<span[^>]*class="icon[^"]*"[^>]*>.*?</span>', '', body)
            body = re.sub(r' (style|onclick|id="(?:arr|img)[^"]*)="[^"]*"', '', body)
            if '<!-- contents -->' not in body and body.count('<div') > body.count('</div>'):
                body += '</div>' * (body.count('<div') - body.count('</div>'))
            self.write(f'reference/{language}/{file.name}', title, body, 'reference')

    def make(self):
        for each in self.documents:
            self.document(each)
        for language in ('cpp', 'c'):
            self.reference_pages(language)
        shutil.copyfile(self.root / 'demo/site/style.css', self.out / 'style.css')
        if (self.root / 'build/page/index.html').exists():
            shutil.copytree(self.root / 'build/page', self.out / 'page')


Site(*map(pathlib.Path, sys.argv[1:4])).make()
