# page.mk - the page: the same sources as WebAssembly, in one HTML file that needs nothing else.
PAGE       = page/page $(READER) $(addprefix program/,run warn edge_load)
PAGE_CC    = clang --target=wasm32-wasi -mexec-model=reactor -flto -D_WASI_EMULATED_PROCESS_CLOCKS
PAGE_CALLS = malloc free $(addprefix page_,load free state step hold pull text numbers data)
PAGE_FILES = $(addprefix page/,page.html style.css assemble.awk) $(wildcard page/*.js)
PAGE_DATA  = out/bbm.wasm $(wildcard cases/models/*.model cases/models/*.msh) doc/by-hand.model out/exercises.txt \
             out/states.txt out/statements.txt

page: out/bbm.html

out/bbm.wasm: $(PAGE:%=%.c) $(LIBRARY:%=%.c) $(HEADERS) Makefile page/page.mk
	@mkdir -p $(@D)
	$(PAGE_CC) $(STRICT) -O2 -o $@ $(PAGE:%=%.c) $(LIBRARY:%=%.c) $(PAGE_CALLS:%=-Wl,--export=%) \
	-Wl,--strip-all,--stack-first,-z,stack-size=1048576 -lm -lwasi-emulated-process-clocks

# The exercises of the kind predict, as they stand in the chapters, and the tables of states and of
# statements.
out/exercises.txt: page/exercises.awk $(wildcard doc/0*.md)
	@mkdir -p $(@D)
	awk -f $^ > $@

out/states.txt: doc/06-contact.md
	@mkdir -p $(@D)
	grep -E '^\| (OPEN|LOCK|SLIDE) ' $< > $@

out/statements.txt: doc/model-file.md
	@mkdir -p $(@D)
	sed -n '/^## Statements/,/^WHERE/p' $< | grep '^| `' > $@

out/bbm.html: $(PAGE_FILES) $(PAGE_DATA) page/page.mk
	awk -f page/assemble.awk page/page.html $(PAGE_DATA) > $@

# The page in node and in Chromium, and natively with musl, whose libm is that of WASI.
check-page: out/bbm.html $O/bbm $O/musl/page_native
	@rm -rf out/page && mkdir -p out/page
	node tests/check_page.js $O/bbm $O/musl/page_native out/page

$O/musl/page_native: tests/page_native.c $(PAGE:%=%.c) $(LIBRARY:%=%.c) $(HEADERS) Makefile
	@mkdir -p $(@D)
	musl-gcc $(STRICT) -O2 -o $@ $(filter %.c,$^) -lm

.PHONY: page check-page
