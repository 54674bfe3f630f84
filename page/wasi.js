/* wasi.js - the eleven calls of WASI that the sources make: a clock, and files that live in `files`
 * by their names. memory(): asked for each time, since memory that grows is another buffer. */
'use strict';

function wasi(files, memory, say) {
  const BAD_FILE = 8, NOT_THERE = 44, NO_SEEK = 70, FOLDER = 3;
  const open = new Map();
  const view = () => new DataView(memory().buffer);
  const bytes = (at, n) => new Uint8Array(memory().buffer, at, n);
  const put = (at, value) => view().setUint32(at, value, true);
  /* Each of the n pieces of memory of a list; the sum of what `each` returns goes to done. */
  const pieces = (list, n, done, each) => {
    let sum = 0;
    for (let k = 0; k < n; k++)
      sum += each(bytes(view().getUint32(list + 8 * k, true),
        view().getUint32(list + 8 * k + 4, true)));
    put(done, sum);
    return 0;
  };

  return {
    clock_time_get(id, precision, at) {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    proc_exit(code) { throw Error(`the program ended with ${code}`); },
    fd_prestat_get(fd, at) {                    /* one folder, "." */
      if (fd !== FOLDER)
        return BAD_FILE;
      put(at, 0);
      put(at + 4, 1);
      return 0;
    },
    fd_prestat_dir_name(fd, at) { bytes(at, 1)[0] = 46; return 0; },
    fd_fdstat_get(fd, at) {
      if (fd > FOLDER && !open.has(fd))
        return BAD_FILE;
      bytes(at, 24).fill(255, 8);               /* all rights */
      bytes(at, 8).set([fd === FOLDER ? 3 : 4, 0, 0, 0]);
      return 0;
    },
    fd_fdstat_set_flags() { return 0; },
    fd_seek() { return NO_SEEK; },
    path_open(folder, flags, name, n, how, rights, inherited, mode, fd) {
      const text = files.get(new TextDecoder().decode(bytes(name, n)));
      if (text === undefined)
        return NOT_THERE;
      let free = FOLDER + 1;
      while (open.has(free))
        free++;
      open.set(free, { bytes: new TextEncoder().encode(text), at: 0 });
      put(fd, free);
      return 0;
    },
    fd_read(fd, list, n, done) {
      const file = open.get(fd);
      return file ? pieces(list, n, done, room => {
        const part = file.bytes.subarray(file.at, file.at + room.length);
        room.set(part);
        file.at += part.length;
        return part.length;
      }) : BAD_FILE;
    },
    fd_write(fd, list, n, done) {                 /* messages: stdout and stderr */
      return pieces(list, n, done, piece => {
        say(new TextDecoder().decode(piece));
        return piece.length;
      });
    },
    fd_close(fd) { return open.delete(fd) ? 0 : BAD_FILE; },
  };
}
