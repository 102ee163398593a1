<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<!-- What options are for (host/features/schema/option_rows.cpp), as dialogs show it: a label up to the first of
     ": ", " (" and "; "; what is taken where nothing is stated behind "(Standard: ". Words that are typed stay; those
     that are chosen from a list follow as "Choice". -->
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>Option</name>
    <message>
        <source>frames a second that the video is played with (default: 24)</source>
        <translation>Bilder pro Sekunde, mit denen der Film abgespielt wird (Standard: 24)</translation>
    </message>
    <message>
        <source>seconds of the capture in a second of the video: 0.25 is four times slower than life (default: 1)</source>
        <translation>Sekunden der Aufnahme pro Sekunde Film: 0.25 ist viermal langsamer als das Leben (Standard: 1)</translation>
    </message>
    <message>
        <source>how long each frame is exposed: 360 is all the time to the next; more makes them overlap (default: 180)</source>
        <translation>wie lange jedes Bild belichtet wird: 360 ist die ganze Zeit bis zum nächsten; bei mehr überlappen sie (Standard: 180)</translation>
    </message>
    <message>
        <source>where in the capture the video starts: 0.4s, 37f (default: 0s)</source>
        <translation>wo in der Aufnahme der Film beginnt: 0.4s, 37f (Standard: 0s)</translation>
    </message>
    <message>
        <source>where in the capture the video ends; frames that would go on behind it are left out (default: the capture&apos;s end)</source>
        <translation>wo in der Aufnahme der Film endet; Bilder, die darüber hinausgingen, entfallen (Standard: das Ende der Aufnahme)</translation>
    </message>
    <message>
        <source>the codec: ffv1 (lossless; .mkv, .avi), h264, h265 (.mp4, .mov, .mkv), av1 (.mp4, .mkv, .webm), vp9 (.webm, .mkv), mjpeg (.avi, .mov, .mkv); of 10 bits h264-10, h265-10, av1-10; for editors prores, prores-proxy, -lt, -422, -4444 (.mov, .mkv), dnxhr-lb, -sq, -hq, -hqx, -444 (.mov, .mxf); gif, webp (default: h264, in .mkv and .avi ffv1, in .webm vp9, in .mxf dnxhr-hqx)</source>
        <translation>der Codec: ffv1 (verlustfrei; .mkv, .avi), h264, h265 (.mp4, .mov, .mkv), av1 (.mp4, .mkv, .webm), vp9 (.webm, .mkv), mjpeg (.avi, .mov, .mkv); mit 10 Bit h264-10, h265-10, av1-10; für den Schnitt prores, prores-proxy, -lt, -422, -4444 (.mov, .mkv), dnxhr-lb, -sq, -hq, -hqx, -444 (.mov, .mxf); gif, webp (Standard: h264, in .mkv und .avi ffv1, in .webm vp9, in .mxf dnxhr-hqx)</translation>
    </message>
    <message>
        <source>quality on the codec&apos;s own scale: h264 1 … 51, h265 0 … 51 (default: 17), av1, vp9 0 … 63, mjpeg 2 … 31, the less the better; webp 0 … 100</source>
        <translation>Qualität in der Skala des Codecs: h264 1 … 51, h265 0 … 51 (Standard: 17), av1, vp9 0 … 63, mjpeg 2 … 31, weniger ist besser; webp 0 … 100</translation>
    </message>
    <message>
        <source>quality from 1 to 100: of .jpg pictures, and of films whose codec loses something (default: 90 of .jpg, of films the codec&apos;s)</source>
        <translation>Qualität von 1 bis 100: von .jpg-Bildern, und von Filmen, deren Codec Verluste hat (Standard: 90 bei .jpg, bei Filmen die des Codecs)</translation>
    </message>
    <message>
        <source>bits of the picture: 8, 16, float, double (.tif, .npy) or half (.exr): light as it is, with negatives (default: the capture&apos;s own, 8 for .jpg, float for .exr, .pfm and .npy)</source>
        <translation>Bits des Bildes: 8, 16, float, double (.tif, .npy) oder half (.exr): Licht, wie es ist, auch negatives (Standard: die der Aufnahme, 8 bei .jpg, float bei .exr, .pfm und .npy)</translation>
    </message>
    <message>
        <source>the clip&apos;s sound: clip (as it is, if the film runs as fast as the file), stretch (as slow or fast as the film) or no (default: clip)</source>
        <translation>der Ton des Clips: wie im Clip (wenn der Film so schnell läuft wie die Datei), gedehnt (so langsam oder schnell wie der Film) oder ohne Ton (Standard: wie im Clip)</translation>
    </message>
    <message>
        <source>what the picture shows: trail (sharp moments over the whole way), strobe (moments alone), rear-curtain (the last moment, and a trail that grows towards it), frozen (one moment in a scene exposed for all of the time), clean (the scene without moving things) or slit (strips, each later than the one before it) (default: trail)</source>
        <translation>was das Bild zeigt: Bewegungsstudie (scharfe Momente über dem ganzen Weg), Stroboskop (nur Momente), zweiter Vorhang (der letzte Moment, und eine Spur, die zu ihm hin zunimmt), eingefrorenes Motiv (ein Moment in einer Szene, die die ganze Zeit belichtet wird), leere Szene (ohne Bewegtes) oder Slit-Scan (Streifen, jeder später als der vor ihm) (Standard: Bewegungsstudie)</translation>
    </message>
    <message>
        <source>how many moments, or which: up to 50, 7, or 0.36s,0.75s,1.27s (default: 5; of rear-curtain and frozen 1); of slit how many strips, up to 256 (default: 256)</source>
        <translation>wie viele Momente, oder welche: bis 50, 7, oder 0.36s,0.75s,1.27s (Standard: 5; bei zweitem Vorhang und eingefrorenem Motiv 1); beim Slit-Scan die Zahl der Streifen, bis 256 (Standard: 256)</translation>
    </message>
    <message>
        <source>how moments are evenly apart: in time, or along the way (default: time)</source>
        <translation>worin Momente gleich weit auseinander sind: in der Zeit oder auf dem Weg (Standard: in der Zeit)</translation>
    </message>
    <message>
        <source>the trail&apos;s shape: even, fade (ends at nothing), ramp (begins at nothing) or none (default: even of trail and frozen, ramp of rear-curtain, none of strobe)</source>
        <translation>die Form der Spur: gleichmäßig, abnehmend (endet im Nichts), zunehmend (beginnt im Nichts) oder keine (Standard: passend zum Bild; gleichmäßig bei Bewegungsstudie und eingefrorenem Motiv, zunehmend beim zweiten Vorhang, keine beim Stroboskop)</translation>
    </message>
    <message>
        <source>where slit begins: left, right (columns), top or bottom (rows) (default: left)</source>
        <translation>wo der Slit-Scan beginnt: links, rechts (Spalten), oben oder unten (Zeilen) (Standard: links)</translation>
    </message>
    <message>
        <source>pictures a second that the clip was filmed with: 120, 29.97, 30000/1001 (default: what the file says)</source>
        <translation>Bilder pro Sekunde, mit denen der Clip gefilmt wurde: 120, 29.97, 30000/1001 (Standard: was die Datei sagt)</translation>
    </message>
    <message>
        <source>keep the camera still: move each picture onto the first one by translation, rigid (turning, too), homography (whatever a camera on the spot does) or auto (rigid, or homography where that says more); the clip is read twice</source>
        <translation>die Kamera stillhalten: jedes Bild auf das erste schieben mit translation (Verschiebung), rigid (auch Drehung), homography (alles, was eine Kamera auf der Stelle tut) oder auto (rigid, oder homography, wo das mehr erklärt); der Clip wird zweimal gelesen</translation>
    </message>
    <message>
        <source>expose all pictures as the first one: undo a camera&apos;s automatic exposure and white balance</source>
        <translation>alle Bilder wie das erste belichten: hebt Belichtungsautomatik und Weißabgleich der Kamera auf</translation>
    </message>
    <message>
        <source>make samples between pictures, along the motion: auto (as many as no step is longer than about a pixel, none where nothing moves), or how many, 1 … 63; auto:10f..20f, between these pictures alone; the clip is read twice (default: off; a study makes them where its trail has gaps, a video where its frames mix pictures)</source>
        <translation>Samples zwischen den Bildern erzeugen, entlang der Bewegung: auto (so viele, dass kein Schritt länger als etwa ein Pixel ist, keine, wo sich nichts bewegt), oder wie viele, 1 … 63; auto:10f..20f, nur zwischen diesen Bildern; der Clip wird zweimal gelesen (Standard: off; eine Studie erzeugt sie, wo ihre Spur Lücken hat, ein Film, wo seine Bilder Bilder mischen)</translation>
    </message>
    <message>
        <source>how the picture&apos;s codes stand for light: srgb, bt709, linear, gamma:G, or source: as in the capture, with its own white code (default: srgb, white being the largest code)</source>
        <translation>wie die Codes des Bildes für Licht stehen: srgb, bt709, linear, gamma:G, oder source: wie in der Aufnahme, mit ihrem Weißcode (Standard: srgb, Weiß ist der größte Code)</translation>
    </message>
    <message>
        <source>what codes make of light below 0: saturate (black), offset (light 0 is mid-grey, light below it darker), abs (as bright as light above it) (default: saturate)</source>
        <translation>was Codes aus Licht unter 0 machen: Schwarz, Grau (Licht 0 ist Mittelgrau, Licht darunter dunkler) oder Betrag (so hell wie Licht darüber) (Standard: Schwarz)</translation>
    </message>
    <message>
        <source>keep pixels that are not square: to measure in them (default: .png, .jpg and films of lossy codecs come in square ones, unless --depth 16 or --out-transfer source is stated; other files as they are)</source>
        <translation>nicht quadratische Pixel behalten: um in ihnen zu messen (Standard: .png, .jpg und Filme verlustbehafteter Codecs haben quadratische, außer mit --depth 16 oder --out-transfer source; andere Dateien die der Aufnahme)</translation>
    </message>
    <message>
        <source>do not keep in the picture how it was made: names, functions and options (see nutik-cl reproduce)</source>
        <translation>nicht im Bild ablegen, wie es entstand: Namen, Funktionen und Optionen (siehe nutik-cl reproduce)</translation>
    </message>
</context>
<context>
    <name>Choice</name>
    <message>
        <source>trail</source>
        <translation>Bewegungsstudie</translation>
    </message>
    <message>
        <source>strobe</source>
        <translation>Stroboskop</translation>
    </message>
    <message>
        <source>rear-curtain</source>
        <translation>zweiter Vorhang</translation>
    </message>
    <message>
        <source>frozen</source>
        <translation>eingefrorenes Motiv</translation>
    </message>
    <message>
        <source>clean</source>
        <translation>leere Szene</translation>
    </message>
    <message>
        <source>slit</source>
        <translation>Slit-Scan</translation>
    </message>
    <message>
        <source>time</source>
        <translation>in der Zeit</translation>
    </message>
    <message>
        <source>distance</source>
        <translation>auf dem Weg</translation>
    </message>
    <message>
        <source>even</source>
        <translation>gleichmäßig</translation>
    </message>
    <message>
        <source>fade</source>
        <translation>abnehmend</translation>
    </message>
    <message>
        <source>ramp</source>
        <translation>zunehmend</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>left</source>
        <translation>links</translation>
    </message>
    <message>
        <source>right</source>
        <translation>rechts</translation>
    </message>
    <message>
        <source>top</source>
        <translation>oben</translation>
    </message>
    <message>
        <source>bottom</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>clip</source>
        <translation>wie im Clip</translation>
    </message>
    <message>
        <source>stretch</source>
        <translation>gedehnt</translation>
    </message>
    <message>
        <source>no</source>
        <translation>ohne Ton</translation>
    </message>
    <message>
        <source>saturate</source>
        <translation>Schwarz</translation>
    </message>
    <message>
        <source>offset</source>
        <translation>Grau</translation>
    </message>
    <message>
        <source>abs</source>
        <translation>Betrag</translation>
    </message>
</context>
</TS>
