"""Damages bytes, texts and YAML files, each by its own seed."""

import random
import re

NUMBERS = ["0", "-1", "1", "-0.0", "1e-308", "1e-9", "0.001", "1e9", "-1e9", "9.2e18", "1e308", "-1e308", ".nan", ".inf",
           "500000", "4294967296", "9223372036854775808", "1" * 400, "0x1f", "1_000", "65536", "255", "-32769"]
ODD = ["", "~", "[]", "{}", "null", "true", "'", "\"", "[0, 0, 0]", "{a: b}", "abc", "../x", "/", "\u00e9\u4e2d", "a" * 5000,
       "&a [*a]", "!!binary AA==", "- -", "? :", "%", "*x"]
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?(?![\w.])")


def damage_bytes(data: bytes, rng: random.Random) -> bytes:
    """Flips, cuts, repeats, inserts and overwrites bytes, often near the start, where headers are."""
    out = bytearray(data)
    for _ in range(rng.choice([1, 1, 1, 2, 4, 16])):
        size = len(out)
        if size == 0:
            break
        at = rng.randrange(min(size, 512)) if rng.random() < 0.6 else rng.randrange(size)
        count = min(rng.choice([1, 1, 2, 4, 8, 64]), size - at)
        kind = rng.randrange(8)
        if kind == 0:
            out[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            out[at:at + count] = bytes(rng.choice([0x00, 0xFF, 0x7F, 0x80]) for _ in range(count))
        elif kind == 2:
            del out[at:at + count]
        elif kind == 3:
            out[at:at] = out[at:at + count]
        elif kind == 4:
            out[at:at] = bytes(rng.randrange(256) for _ in range(count))
        elif kind == 5:
            del out[at:]
        elif kind == 6:
            other = rng.randrange(size)
            out[at:at + count] = out[other:other + count]
        else:
            width = rng.choice([2, 4, 8])
            value = rng.choice([0, 1, 2**(8 * width - 1) - 1, 2**(8 * width) - 1, 2**(8 * width - 1), 65536])
            out[at:at + width] = (value % 2**(8 * width)).to_bytes(width, rng.choice(["little", "big"]))
    return bytes(out)


def damage_text(data: bytes, rng: random.Random) -> bytes:
    """Numbers, words and lines of a text; now and then its bytes."""
    if rng.random() < 0.3:
        return damage_bytes(data, rng)
    for _ in range(rng.choice([1, 1, 1, 2, 5])):
        kind = rng.randrange(6)
        lines = data.split(b"\n")
        at = rng.randrange(len(lines))
        if kind <= 2:
            found = list(NUMBER.finditer(data))
            if found:
                one = rng.choice(found)
                new = rng.choice(NUMBERS + ODD[:4]).encode()
                data = data[:one.start()] + new + data[one.end():]
            continue
        if kind == 3:
            del lines[at]
        elif kind == 4:
            lines.insert(rng.randrange(len(lines) + 1), lines[at])
        else:
            words = lines[at].split(b" ")
            words[rng.randrange(len(words))] = rng.choice(ODD).encode()
            lines[at] = b" ".join(words)
        data = b"\n".join(lines)
    return data


KEY = re.compile(r"^(\s*(?:- )?)([\w.]+):(.*)$")


def damage_yaml(text: str, rng: random.Random) -> bytes:
    """Keys, values, indentation and order of a scenario; now and then its bytes."""
    if rng.random() < 0.08:
        return damage_bytes(text.encode(), rng)
    lines = text.split("\n")
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        keyed = [i for i, line in enumerate(lines) if KEY.match(line)]
        if not keyed:
            break
        at = rng.choice(keyed)
        indent, key, rest = KEY.match(lines[at]).groups()
        kind = rng.randrange(10)
        if kind <= 4:  # a value
            found = list(NUMBER.finditer(rest.encode()))
            if found and rng.random() < 0.8:
                one = rng.choice(found)
                rest = rest.encode()[:one.start()].decode() + rng.choice(NUMBERS) + rest.encode()[one.end():].decode()
            else:
                rest = " " + rng.choice(ODD + NUMBERS)
            lines[at] = f"{indent}{key}:{rest}"
        elif kind == 5:  # a key
            i = rng.randrange(len(key))
            wrong = rng.choice([key[:i] + key[i + 1:], key + "x", key.upper(), rng.choice(ODD), key.replace("_", "")])
            lines[at] = f"{indent}{wrong}:{rest}"
        elif kind == 6:
            del lines[at]
        elif kind == 7:
            lines.insert(rng.randrange(len(lines) + 1), lines[at])
        elif kind == 8:
            lines[at] = rng.choice([" ", "  ", "    ", "\t", "- "]) + lines[at]
        else:
            other = rng.choice(keyed)
            lines[at], lines[other] = lines[other], lines[at]
    return "\n".join(lines).encode("utf-8", "replace")


def odd_values(text: str, rng: random.Random) -> bytes:
    """Only numbers of a scenario that is valid: factors as well as absurd ones."""
    lines = text.split("\n")
    places = [(i, m) for i, line in enumerate(lines) if not line.startswith("vinerow:")
              for m in NUMBER.finditer(line.split("#")[0].encode())]
    for _ in range(rng.choice([1, 1, 1, 2])):
        i, one = rng.choice(places)
        line = lines[i].encode()
        if one.end() > len(line):
            continue
        try:
            value = float(one.group())
        except ValueError:
            continue
        whole = b"." not in one.group() and b"e" not in one.group().lower()
        scaled = value * rng.choice([-1, 0.5, 2, 10, 100, 1e3, 1e6, 0.1, 1e-3, 1e-6])
        new = (rng.choice(NUMBERS) if rng.random() < 0.4 else str(int(scaled)) if whole and abs(scaled) < 1e18
               else repr(scaled))
        lines[i] = (line[:one.start()] + new.encode() + line[one.end():]).decode()
        places = [(k, m) for k, m in places if k != i]
    return "\n".join(lines).encode()
