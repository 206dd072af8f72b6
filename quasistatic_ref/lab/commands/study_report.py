"""``study report``, ``study pack``, ``study merge``: what is done with a store that was run."""

import argparse


def run_report(options: argparse.Namespace) -> int:
    """Write ``report.html``, ``report.md`` and ``figures``."""
    from quasistatic_ref.formats.files import bytes_written, text_written, writable_folder
    from quasistatic_ref.lab.figures.study_images import images
    from quasistatic_ref.lab.page.html import html_page, sorting_script
    from quasistatic_ref.lab.page.markdown import markdown_page
    from quasistatic_ref.lab.study.report.report import study_report

    out = options.store / "report" if options.out is None else options.out
    report = study_report(options.store, out)
    folder = writable_folder(out / "figures")
    inside = {}
    for picture in report.pictures:
        found = images(picture.kind, picture.data)
        inside[picture.name] = found["svg"]
        print(f"wrote {bytes_written(folder / f'{picture.name}.png', found['png'])}")
    pages = {
        "report.md": markdown_page(report),
        "report.html": html_page(report, inside, sorting_script()),
    }
    for name, text in pages.items():
        print(f"wrote {text_written(out / name, text)}")
    return 0


def run_pack(options: argparse.Namespace) -> int:
    """Write the packed store."""
    from quasistatic_ref.lab.study.store.pack import packed_store

    out = options.store / "packed" if options.out is None else options.out
    print(f"wrote {packed_store(options.store, out)}")
    return 0


def run_merge(options: argparse.Namespace) -> int:
    """Write the merged store."""
    from quasistatic_ref.lab.study.store.merge import merged_store, part_read

    parts = [part_read(words) for words in options.parts]
    folder = merged_store(parts, options.out)
    rows = sum(len(part.found.rows) for part in parts)
    machines = {m for p in parts for m in p.machines}
    print(f"wrote {folder}: {rows:,} rows of {len(machines)} machines")
    return 0
