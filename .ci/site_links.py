# SPDX-License-Identifier: BSD-3-Clause
"""What mkdocs calls for each page: links to files beside docs/ (configs, sources) become their names, as the site has
no such files."""

import os
import re


def on_page_markdown(markdown, page, config, files):
    folder = os.path.dirname(page.file.src_path)

    def replaced(match):
        text, target = match[1], match[2]
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        path = os.path.normpath(os.path.join(folder, target.partition("#")[0]))
        if not path.startswith(".."):
            is_folder = os.path.isdir(os.path.join(config["docs_dir"], path))
            return f"{text} (docs/{path})" if is_folder else match[0]
        name = path.replace("../", "")
        return f"`{name}`" if text.strip("/`") in name else f"{text} (`{name}`)"

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^()\s]+)\)", replaced, markdown)
