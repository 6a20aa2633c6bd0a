"""File uploads of pages in chunks, within limits for all pages of a viewer."""

import threading
import weakref

from ravemj.gui.viewers.dropping import Upload
from ravemj.gui.viewers.web.messages import UploadChunk

_MOST_UNFINISHED = 16
_MOST_BYTES = 256 * 2**20
_TOO_MANY = f"Too many files are on their way: at most {_MOST_UNFINISHED} uploads and {_MOST_BYTES >> 20} MiB at a time"


class UploadQuota:
    """Byte quota of the uploads of all pages. An upload counts until its files are removed."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._sizes: weakref.WeakKeyDictionary[Upload, int] = weakref.WeakKeyDictionary()
        self._unfinished: weakref.WeakSet[Upload] = weakref.WeakSet()

    def reserve(self, upload: Upload, size: int) -> bool:
        """Reserve bytes for an unfinished upload; return False if the quota or the number of uploads is exceeded."""
        with self._lock:
            is_known = upload in self._unfinished
            if len(self._unfinished) + (not is_known) > _MOST_UNFINISHED:
                return False
            if sum(self._sizes.values()) + size > _MOST_BYTES:
                return False
            self._unfinished.add(upload)
            self._sizes[upload] = self._sizes.get(upload, 0) + size
            return True

    def finish(self, upload: Upload) -> None:
        """Record that an upload is complete or was cancelled."""
        with self._lock:
            self._unfinished.discard(upload)


class PageUploads:
    """The uploads of one page, one at a time.

    Attributes:
        complete: Complete uploads, to be added to the environment.
    """

    def __init__(self, quota: UploadQuota) -> None:
        self._quota = quota
        self._upload: Upload | None = None
        self._is_refused = False
        self.complete: list[Upload] = []

    def add(self, chunk: UploadChunk) -> str:
        """Add a chunk; return the reason if the upload is refused, once per upload, else an empty text."""
        trouble = "" if self._is_refused else self._write(chunk)
        if trouble:
            self.close()
            self._is_refused = True
        if chunk.is_last:
            if self._upload is not None:
                self.complete.append(self._upload)
            self.close()
            self._is_refused = False
        return trouble

    def _write(self, chunk: UploadChunk) -> str:
        try:
            upload = self._upload = self._upload or Upload()
            if not self._quota.reserve(upload, len(chunk.data)):
                return _TOO_MANY
            return "" if upload.append(chunk.name, chunk.data) else "The files that were dropped are too large"
        except OSError as error:
            return f"{chunk.name}: {error.strerror or error}"

    def close(self) -> None:
        """Discard the unfinished upload."""
        if self._upload is not None:
            self._quota.finish(self._upload)
        self._upload = None
