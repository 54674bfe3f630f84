/* wasi.js - the eleven calls of WASI that the sources make: a clock, and files that live in `files`
 * by their names. memory(): asked for each time, since memory that grows is another buffer. Pointers
 * arrive with a sign (>>> 0): beyond 2 GB they are negative. */
'use strict';

function wasi(files, memory, say) {
  const BAD_FILE = 8, NOT_THERE = 44, NO_SEEK = 70, FOLDER = 3, open = Array(FOLDER + 1);
  const view = () => new DataView(memory().buffer);
  const bytes = (at, n) => new Uint8Array(memory().buffer, at >>> 0, n);
  const put = (at, value) => view().setUint32(at >>> 0, value, true);
  /* A call that visits each of the n pieces of memory of a list; what `visit` returns is summed. */
  const pieces = visit => (fd, list, n, done) => {
    let sum = 0;
    for (let k = list >>> 0, end = k + 8 * n; k < end; k += 8)
      sum += visit(bytes(view().getUint32(k, true), view().getUint32(k + 4, true)), open[fd]);
    put(done, sum);
    return 0;
  };

  return {
    clock_time_get(id, precision, at) {
      view().setBigUint64(at >>> 0, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    proc_exit(code) { throw Error(`the program ended with ${code}`); },
    fd_prestat_get(fd, at) {                    /* one folder, "." */
      bytes(at, 8).set([0, 0, 0, 0, 1, 0, 0, 0]);
      return fd === FOLDER ? 0 : BAD_FILE;
    },
    fd_prestat_dir_name(fd, at) { bytes(at, 1)[0] = 46; return 0; },
    fd_fdstat_get(fd, at) {                     /* a folder or a file, with all rights */
      bytes(at, 24).fill(255, 8).set([fd === FOLDER ? 3 : 4, 0, 0, 0, 0, 0, 0, 0]);
      return 0;
    },
    fd_fdstat_set_flags() { return 0; },
    fd_seek() { return NO_SEEK; },
    path_open(folder, flags, name, n, how, rights, inherited, mode, fd) {
      const text = files.get(new TextDecoder().decode(bytes(name, n)));
      put(fd, open.push({ bytes: new TextEncoder().encode(text), at: 0 }) - 1);
      return text === undefined ? NOT_THERE : 0;
    },
    fd_read: pieces((room, file) => {
      const part = file.bytes.subarray(file.at, file.at + room.length);
      room.set(part);
      file.at += part.length;
      return part.length;
    }),
    fd_write: pieces(piece => {                 /* messages: stdout and stderr */
      say(new TextDecoder().decode(piece));
      return piece.length;
    }),
    fd_close(fd) { delete open[fd]; return 0; },
  };
}
