"""The precision of FLINT, which all threads of a process share."""

from threading import Thread

from flint import ctx

from quasistatic_ref.numbers.precision import working_precision


def test_a_precision_lasts_until_its_block_ends_whatever_other_threads_ask_for():
    before = ctx.prec
    reached = []

    def ask():
        with working_precision(300):
            reached.append(ctx.prec)

    with working_precision(200):
        other = Thread(target=ask)
        other.start()
        other.join(0.05)
        with working_precision(100):
            assert ctx.prec == 100
        assert ctx.prec == 200
        assert reached == []
    other.join()
    assert reached == [300]
    assert ctx.prec == before
