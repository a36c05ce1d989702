/** Two short tones, made here: nothing has to be loaded for them. */

const TONES_HZ = [660, 880];
const TONE_S = 0.16;
const LOUDNESS = 0.15;

export function beep() {
  const audio = new AudioContext();
  TONES_HZ.forEach((frequency, index) => {
    const [tone, volume] = [new OscillatorNode(audio, { frequency }), new GainNode(audio, { gain: LOUDNESS })];
    const begin = audio.currentTime + index * TONE_S;
    tone.connect(volume).connect(audio.destination);
    volume.gain.setTargetAtTime(0, begin + TONE_S / 2, TONE_S / 6);
    tone.start(begin);
    tone.stop(begin + TONE_S);
    if (index === TONES_HZ.length - 1) tone.onended = () => audio.close();
  });
}
