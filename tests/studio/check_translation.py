"""nutik-studio in German: a text for each one in the source, with the same placeholders."""
import argparse
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

SKIPPED = 77


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--lupdate", required=True)
    parser.add_argument("--host", required=True, type=Path)
    arguments = parser.parse_args()
    if not Path(arguments.lupdate).exists():
        print("skipped: no lupdate (Debian: qt6-l10n-tools)")
        return SKIPPED
    texts = arguments.host / "studio" / "translations"
    with tempfile.TemporaryDirectory() as name:
        updated = shutil.copy(texts / "nutik_studio_de.ts", name)
        subprocess.run([arguments.lupdate, "-silent", "-locations", "none", "-I", arguments.host,
                        arguments.host / "studio", "-ts", updated], check=True)
        mistakes = []
        files = [updated, texts / "options_de.ts"]
        messages = [message for file in files for message in xml.parse(file).iter("message")]
        for message in messages:
            source, translation = message.find("source").text, message.find("translation")
            forms = [form.text for form in translation.iter("numerusform")] or [translation.text]
            if translation.get("type"):
                mistakes.append(f"{translation.get('type')}: {source}")
            for form in forms:
                for pattern in (r"%L?(?:\d|n)", r"^\s*", r"\s*$", r"…$"):
                    if sorted(re.findall(pattern, source)) != sorted(re.findall(pattern, form or "")):
                        mistakes.append(f"{source!r} has another {pattern} than {form!r}")
    if mistakes:
        mistakes.append("To mend them: lupdate -locations none -I host host/studio -ts "
                        "host/studio/translations/nutik_studio_de.ts")
    print("\n".join(mistakes) or f"{len(messages)} texts")
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
