# SPDX-License-Identifier: BSD-3-Clause
"""Compares the pages of messages with the sources: messages_test.py SOURCE_FOLDER"""

import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import messages  # noqa: E402
import messages_page  # noqa: E402

ROOT = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path(".")
TROUBLESHOOT = ROOT / "docs/how-to/troubleshoot.md"


def entries():
    """Of each entry its texts (heading and quoted ones) and its body."""
    parts = re.split(r"^### `(.+)`$", TROUBLESHOOT.read_text(encoding="utf-8"), flags=re.M)
    for heading, body in zip(parts[1::2], parts[2::2]):
        yield [heading] + re.findall(r"^> (.+)$", body, flags=re.M), body.split("\n## ")[0]


def matches(text, message):
    """Whether a text with … for values occurs in a message."""
    pieces = [piece.strip() for piece in text.split(messages.VALUE)]
    return re.search(".*".join(re.escape(piece) for piece in pieces), message) is not None


class Messages(unittest.TestCase):
    def test_page_of_errors_and_warnings_is_that_of_the_sources(self):
        written = (ROOT / "docs/reference/messages.md").read_text(encoding="utf-8")
        self.assertTrue(written == messages_page.page(ROOT),
                        "run: python3 tests/docs/messages_page.py . > docs/reference/messages.md")

    def test_every_error_of_the_sources_has_advice(self):
        found = messages.errors(ROOT)
        self.assertGreater(len(found), 300)
        for name, message, advice in found:
            with self.subTest(message):
                self.assertTrue(advice, f"{name}: an error tells what to do, as the second argument of Error: {message}")

    def test_every_caveat_of_the_sources_has_an_entry(self):
        texts = [text for entry, _ in entries() for text in entry]
        found, relays = messages.caveats(ROOT)
        self.assertGreater(len(found), 25)
        for name, message in found:
            with self.subTest(message):
                self.assertTrue(any(matches(text, message) for text in texts),
                                f"docs/how-to/troubleshoot.md lacks this caveat of {name}: {message}")
        self.assertEqual(relays, messages.RELAYS,
                         "a file marks results by a text from elsewhere: add the file that makes the text to MAKERS in "
                         "tests/docs/messages.py, and correct RELAYS")

    def test_every_function_of_a_caveat_is_in_a_file_that_is_searched(self):
        self.assertEqual(messages.missing_makers(ROOT), [], "add these files to MAKERS in tests/docs/messages.py")

    def test_a_function_of_a_caveat_elsewhere_is_found(self):
        file = "pipeline/estimate/scene_repeat.cpp"
        others = tuple(maker for maker in messages.MAKERS if maker != file)
        self.assertIn((file, "counts_caveat"), messages.missing_makers(ROOT, others))

    def test_every_entry_is_a_message_of_the_sources(self):
        printed = [message for _, message in messages.caveats(ROOT)[0] + messages.warnings(ROOT)]
        printed += [message for _, message, _ in messages.errors(ROOT)]
        for texts, _ in entries():
            for text in texts:
                with self.subTest(text):
                    self.assertTrue(any(matches(text, message) for message in printed),
                                    f"docs/how-to/troubleshoot.md: nothing in the sources prints: {text}")

    def test_every_entry_has_a_cause_and_a_cure(self):
        found = list(entries())
        self.assertGreater(len(found), 40)
        for texts, body in found:
            with self.subTest(texts[0]):
                cause, cure, action = body.partition("**Cure:**")
                self.assertTrue(cause.strip() and cure and action.strip())

    def test_a_caveat_without_an_entry_is_found(self):
        self.assertTrue(matches("… is off by … mm", "front is off by … mm: mend it"))
        self.assertFalse(matches("… is off by … m", "front is on by … mm"))


if __name__ == "__main__":
    unittest.main()
