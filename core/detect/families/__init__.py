"""Networks that people bring as ONNX files, a family a file: what each takes of a picture, and gives."""
