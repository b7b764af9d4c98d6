"""Logs as another writer or a merge would leave them: records of MCAP taken apart and put together in another order.

Needs a log without compression (record: {compression: none})."""

import random
import struct

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, ATTACHMENT, METADATA, DATA_END = 1, 2, 3, 4, 5, 6, 9, 12, 15


def _records(data: bytes) -> list[tuple[int, bytes]]:
    at, found = 0, []
    while at + 9 <= len(data):
        code, length = struct.unpack_from("<BQ", data, at)
        if at + 9 + length > len(data):
            break
        found.append((code, data[at + 9:at + 9 + length]))
        at += 9 + length
    return found


def _text(content: bytes, at: int) -> tuple[bytes, int]:
    length, = struct.unpack_from("<I", content, at)
    return content[at + 4:at + 4 + length], at + 4 + length


class Log:
    def __init__(self, data: bytes) -> None:
        self.head, self.first, self.messages = b"", [], []
        seen = set()
        for code, content in _records(data[len(MAGIC):]):
            if code == HEADER:
                self.head = content
            elif code in (SCHEMA, CHANNEL, ATTACHMENT, METADATA):
                self._add(code, content, seen)
            elif code == CHUNK:
                compression, at = _text(content, 28)
                assert compression == b"", "the log must not be compressed"
                for inner, part in _records(content[at + 8:]):
                    if inner == MESSAGE:
                        self.messages.append(part)
                    else:
                        self._add(inner, part, seen)
            elif code == DATA_END:
                break

    def _add(self, code: int, content: bytes, seen: set) -> None:
        if (code, content) not in seen:
            seen.add((code, content))
            self.first.append((code, content))

    def rearranged(self, rng: random.Random) -> bytes:
        """Another order, other stamps, some messages gone or twice; valid record by record."""
        first, messages = list(self.first), list(self.messages)
        kind = rng.randrange(8)
        if kind == 0:
            rng.shuffle(messages)
        elif kind == 1:
            messages.reverse()
        elif kind == 2:  # two logs, one after the other
            cut = rng.randrange(len(messages))
            messages = messages[cut:] + messages[:cut]
        elif kind == 3:
            messages = [self._at(m, rng, rng.choice([1.0, 0.01])) for m in messages]
        elif kind == 4:
            keep = rng.random()
            messages = [m for m in messages if rng.random() < keep]
        elif kind == 5:
            messages += rng.sample(messages, len(messages) // 3)
        elif kind == 6:  # a channel's messages under another channel
            ids = sorted({m[:2] for m in messages})
            one, other = rng.choice(ids), rng.choice(ids)
            messages = [other + m[2:] if m[:2] == one else m for m in messages]
        else:
            messages = [m[:22] + self._damaged(m[22:], rng) if rng.random() < 0.02 else m for m in messages]
        if rng.random() < 0.2:
            rng.shuffle(first)
        if rng.random() < 0.1:
            del first[rng.randrange(len(first))]
        out = MAGIC + self._record(HEADER, self.head)
        out += b"".join(self._record(code, content) for code, content in first)
        out += b"".join(self._record(MESSAGE, m) for m in messages)
        return out + self._record(DATA_END, b"\0" * 4) + self._record(FOOTER, b"\0" * 20) + MAGIC

    @staticmethod
    def _record(code: int, content: bytes) -> bytes:
        return struct.pack("<BQ", code, len(content)) + content

    @staticmethod
    def _at(message: bytes, rng: random.Random, share: float) -> bytes:
        if rng.random() > share:
            return message
        stamp = rng.choice([0, rng.randrange(10**10), 10**18, 2**63 - 1, 2**64 - 1, rng.randrange(2**64)])
        return message[:6] + struct.pack("<QQ", rng.choice([stamp, 10**9]), stamp) + message[22:]

    @staticmethod
    def _damaged(body: bytes, rng: random.Random) -> bytes:
        out = bytearray(body)
        if out:
            out[rng.randrange(len(out))] = rng.randrange(256)
        return bytes(out[:rng.randrange(len(out) + 1)]) if rng.random() < 0.3 else bytes(out)
