#!/usr/bin/env python3
"""Checks all links and anchors of a folder of pages and prints broken ones (exit status 1). Usage: links.py SITE."""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, file):
        super().__init__()
        self.links, self.anchors, self.unnamed = [], set(), 0
        self.feed(file.read_text(errors='replace'))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ('id', 'name') and value:
                self.anchors.add(value)
            if name in ('href', 'src') and value:
                self.links.append(value)
        if tag == 'img' and 'alt' not in dict(attributes):
            self.unnamed += 1


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = {file: Page(file) for file in sorted(site.rglob('*.html')) if site / 'page' not in file.parents}
    broken, count = [], 0
    for file, page in pages.items():
        name = file.relative_to(site)
        if page.unnamed:
            broken.append(f'{name}: {page.unnamed} pictures without an alternative text')
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            if target.is_dir():
                target /= 'index.html'
            if site not in target.parents or not target.is_file():
                broken.append(f'{name}: {link} leads nowhere')
            elif parts.fragment and target in pages and \
                    urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                broken.append(f'{name}: {link} has no such anchor')
    for each in broken:
        print(each)
    print(f'{len(pages)} pages, {count} links, {len(broken)} broken')
    return 1 if broken else 0


sys.exit(main())
