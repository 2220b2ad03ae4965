# SPDX-License-Identifier: GPL-3.0-or-later
"""A page of mesh-view as its header and its arrays, and a stream as its rows: for tests."""
import base64
import json
import re
import struct
import zlib

from browser import Browser

__all__ = ['Browser', 'Page', 'Stream']

CODES = {'u32': 'I', 'i32': 'i', 'f32': 'f'}


class Page:
    def __init__(self, name):
        with open(name, encoding='utf-8') as file:
            self.text = file.read()
        found = re.search(r'<script type="application/json" id="header">(.*?)</script>',
                          self.text, re.DOTALL)
        self.header = json.loads(found[1])

    def array(self, of):
        begin = '<script type="text/plain" id="array-%d">' % of['array']
        start = self.text.index(begin) + len(begin)
        data = base64.b64decode(self.text[start:self.text.index('<', start)], validate=True)
        bytes_ = zlib.decompress(data, -15)
        n = of['count']
        if of['type'] == 'u8':
            assert len(bytes_) == n
            return list(bytes_)
        assert len(bytes_) == 4 * n
        mixed = bytes(bytes_[i + n * plane] for i in range(n) for plane in range(4))
        return list(struct.unpack('<%d%s' % (n, CODES[of['type']]), mixed))

    def xyz(self, mesh):
        """The nodes where they are in the stream."""
        flat = self.array(self.header['meshes'][mesh]['arrays']['xyz'])
        centre, scale = self.header['centre'], self.header['scale']
        return [[centre[a] + scale * flat[i + a] for a in range(3)]
                for i in range(0, len(flat), 3)]

    def fields(self, mesh):
        return {f['key']: self.array(f['values']) for f in self.header['meshes'][mesh]['fields']}


class Stream:
    def __init__(self, name):
        self.blocks = {}
        with open(name, encoding='utf-8') as file:
            for line in file:
                if line.startswith(('.', 'surface.')):
                    block = self.blocks[line.strip()] = []
                elif not line.startswith(('#', 'termesh')):
                    block.append([self.number(word) for word in line.split()])

    @staticmethod
    def number(word):
        try:
            return int(word)
        except ValueError:
            return word

    def header(self, block):
        return self.blocks[block][0]

    def rows(self, block):
        return self.blocks[block][1:]
