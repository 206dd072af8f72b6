"""What pages repeat is what sources and committed results say."""

from docs.written import main


def test_no_page_would_change(capsys):
    assert main(check=True) == 0, capsys.readouterr().out
