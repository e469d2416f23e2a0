# shellcheck shell=bash
# ./dev train: the weights of the segmentation network.

readonly TRAINING="src/vision/segmentation_training"

command_train() {
  [[ ${1:-} != -- ]] || shift
  setup
  [[ -n ${MICROINJECTION_SKIP_SETUP:-} ]] || setup_training
  build_core "" render_training_images segment_image
  local programs
  programs="$(core_folder)/src"
  say "train: $TRAINING/train.py $*"
  OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 /usr/bin/python3 -B "$ROOT/$TRAINING/train.py" \
    --program "$programs/render_training_images" --out "$ROOT/out/train" "$@" || fail "the training failed (messages above)"
  [[ " $* " == *" --help "* ]] && return
  say "train: the weights are in out/train. Look at images with $programs/segment_image, then copy both files to config/vision"
  ls "$ROOT/out/train"/segmentation.*
}
