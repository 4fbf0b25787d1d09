# cmake -DINPUT=file -DOUTPUT=header -P write_hash.cmake
# Writes the hash of a file that a source takes by .incbin into a header. Compiler caches see headers and no .incbin.
file(SHA256 "${INPUT}" hash)
file(WRITE "${OUTPUT}" "// ${hash}\n")
