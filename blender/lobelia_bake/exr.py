"""Reads the pages of a bake: scan-line OpenEXR, not compressed or ZIP, as named channels."""
import struct
import zlib

import numpy


class Damaged(Exception):
    """A file that is not such a page; the message names it."""


def read_channels(path):
    """Returns {name: array of height x width float32}, the first row at the top."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        return _channels(data)
    except (ValueError, IndexError, KeyError, struct.error, zlib.error) as error:
        raise Damaged(f"{path}: not a page of a bake ({error})") from error


def _text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _channels(data):
    if data[:4] != b"\x76\x2f\x31\x01" or data[5] & 0x02:
        raise ValueError("not a scan-line OpenEXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    names, types, listed = [], [], 0
    while attributes["channels"][listed]:
        name, listed = _text(attributes["channels"], listed)
        types.append(struct.unpack_from("<i", attributes["channels"], listed)[0])
        names.append(name)
        listed += 16
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    compression = attributes["compression"][0]
    rows = {0: 1, 2: 1, 3: 16}[compression]
    sizes = [{1: 2, 2: 4}[kind] for kind in types]
    result = {name: numpy.empty((height, width), numpy.float32) for name in names}
    offsets = struct.unpack_from(f"<{-(-height // rows)}Q", data, at + 1)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        block, count = data[offset + 8:offset + 8 + size], min(rows, height - (y - top))
        expected = count * width * sum(sizes)
        if compression and size < expected:
            block = _unpredicted(zlib.decompress(block))
        if len(block) != expected:
            raise ValueError(f"{len(block)} bytes in place of {expected}")
        place = 0
        for row in range(y - top, y - top + count):
            for name, kind, bytes_each in zip(names, types, sizes):
                values = numpy.frombuffer(block, "<f2" if kind == 1 else "<f4", width, place)
                result[name][row] = values
                place += width * bytes_each
    return result


def _unpredicted(block):
    """Undoes the differences between bytes, and puts the two halves back together."""
    values = numpy.frombuffer(block, numpy.uint8).astype(numpy.int64)
    values[1:] -= 128
    values = (numpy.cumsum(values) & 255).astype(numpy.uint8)
    half = (len(values) + 1) // 2
    out = numpy.empty(len(values), numpy.uint8)
    out[0::2], out[1::2] = values[:half], values[half:]
    return out.tobytes()
