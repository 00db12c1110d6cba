"""The viewer's own files, kept by version: nobody else's are ever used."""

import gzip
import os

import pytest

from upswing.recordings import engine as engine_module
from upswing.recordings.engine import FILES, engine


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, and how often the viewer was asked for its files, which are small here."""
    asked = []
    monkeypatch.setattr(engine_module, "user_cache_path", lambda _: tmp_path / "cache")
    monkeypatch.setattr(
        engine_module, "_fetched", lambda: asked.append(1) or [b"script", b"program"]
    )
    return tmp_path / "cache", asked


def test_the_viewers_own_files_are_handed_out():
    script, program = engine_module._fetched()
    assert script.startswith(b"let wasm_bindgen")
    assert program.startswith(b"\0asm")


def kept(folder):
    return sorted(folder.rglob("*.gz"))


def test_the_viewers_files_are_fetched_once_for_a_version(cache, monkeypatch):
    folder, asked = cache
    first = engine()
    assert [gzip.decompress(packed) for packed in first] == [b"script", b"program"]
    assert engine() == first
    assert len(asked) == 1
    assert [path.stem for path in kept(folder)] == sorted(FILES)
    for path in kept(folder):
        assert path.stat().st_mode & 0o777 == 0o600
        assert path.parent.stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr(engine_module, "version", lambda _: "77.0")
    assert engine() == first
    assert len(asked) == 2


def truncated(path):
    path.write_bytes(path.read_bytes()[:-1])


def one_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))


def writable_by_others(path):
    path.chmod(0o666)


def of_somebody_else(path):
    if os.geteuid():
        pytest.skip("only root can give a file away")
    os.chown(path, 65534, 65534)


def a_link(path):
    path.rename(path.with_name("elsewhere"))
    path.symlink_to("elsewhere")


def a_folder_for_all(path):
    path.parent.chmod(0o777)


@pytest.mark.parametrize(
    "change", [truncated, one_bit, writable_by_others, of_somebody_else, a_link, a_folder_for_all]
)
def test_what_is_kept_is_not_used_if_it_is_damaged_or_could_be_anothers(cache, change):
    folder, asked = cache
    first = engine()
    change(kept(folder)[1])
    assert engine() == first
    assert len(asked) == 2
    if change is not a_folder_for_all:  # then it was kept anew
        assert engine() == first
        assert len(asked) == 2


def test_without_a_cache_it_is_fetched(cache, tmp_path):
    folder, asked = cache
    folder.write_text("a file")
    assert engine() == engine()
    assert len(asked) == 2


def test_what_another_program_answers_is_not_taken_for_the_viewers(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    monkeypatch.setattr(engine_module, "user_cache_path", lambda _: folder)
    monkeypatch.setattr(engine_module, "_answered", lambda _: b"alert(1)")
    with pytest.raises(RuntimeError, match="answered with what is not of"):
        engine()
    assert kept(folder) == []
